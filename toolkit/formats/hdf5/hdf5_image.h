#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

/// Writes HDF5 files without HDF5's library, which cannot leave out the positions of a long
/// sequence and crashes on full disks. Internal to the writers of formats that are HDF5.
///
/// [The HDF Group. HDF5 File Format Specification, version 3.0]
namespace mimetra {

/// Numbers or a text as HDF5 stores them, little-endian.
struct Hdf5Array {
  enum class Type { int64, int32, float32, float64, text };
  template <typename Scalar>
  using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Doubles = Eigen::Ref<const Rows<double>>;
  using Integers = Eigen::Ref<const Rows<int>>;

  Type type;
  std::vector<std::uint64_t> shape;  ///< empty for one number or a text
  std::string bytes;

  static Hdf5Array of(double value);
  static Hdf5Array of(std::string_view text);
  static Hdf5Array of(std::span<const double> values);
  /// Stored as 32-bit integers.
  static Hdf5Array of(std::span<const int> values);
  /// Stored as 64-bit integers.
  static Hdf5Array of(std::span<const std::int64_t> values, std::vector<std::uint64_t> shape);
  /// Stored as float64 or 32-bit integers, rows x columns.
  static Hdf5Array of(const Doubles& matrix);
  static Hdf5Array of(const Integers& matrix);
};

/// Tree of groups, arrays and attributes. It makes the bytes of the HDF5 file, which are equal for
/// equal trees. Paths are "NAME" or "GROUP/NAME"; missing groups are created.
class Hdf5Image {
 public:
  void add(const std::string& path, Hdf5Array array);
  /// Adds an array whose numbers the caller writes, in C order, to place_of(path) after image().
  void reserve(const std::string& path, Hdf5Array::Type type, std::vector<std::uint64_t> shape);
  /// Adds an attribute to the group or array at a path; "" is the top.
  void add_attribute(const std::string& path, const std::string& name, Hdf5Array value);

  /// Returns all bytes before the reserved arrays. The last reserved array ends the file.
  std::string image();
  std::uint64_t place_of(const std::string& path) const { return nodes_.at(path).place; }

 private:
  struct Node {
    bool is_group = true;
    bool is_reserved = false;
    Hdf5Array array = {};
    std::uint64_t place = 0;  ///< offset of an array's numbers
    std::map<std::string, Hdf5Array> attributes = {};
  };

  Node& add_node(const std::string& path, Node node);
  void write_all();
  std::uint64_t write_object(const std::string& path);
  std::string links_of_group(const std::string& path);
  std::uint64_t append(const std::string& bytes);
  std::size_t most_links() const;

  /// Groups and arrays by their paths; the top is "".
  std::map<std::string, Node> nodes_ = {{"", {}}};
  std::string bytes_;
};

}  // namespace mimetra
