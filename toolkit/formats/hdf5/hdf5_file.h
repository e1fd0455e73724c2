#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "toolkit/formats/hdf5/hdf5_fields.h"

/// Reads HDF5 files without HDF5's library, which crashes on damaged files, follows references to
/// other files, and loads plugins. This reader opens only the file itself and checks every address,
/// size and count against it. It reads numbers at the top of a file, in the formats that HDF5 and
/// h5py write by default and as the latest. Internal to the readers of formats that are HDF5.
///
/// [The HDF Group. HDF5 File Format Specification, version 3.0]
namespace mimetra {

/// Array of numbers in a file, which can be read in parts.
class Hdf5Dataset {
 public:
  /// Throws IoError if the object is not an array of numbers, is stored outside the file, or claims
  /// more numbers than the file can contain. Also throws it for filters other than deflate, shuffle
  /// and Fletcher-32.
  Hdf5Dataset(std::shared_ptr<const Hdf5Bytes> file, std::string name,
              const std::vector<Hdf5Message>& messages);

  const std::vector<std::uint64_t>& shape() const { return shape_; }
  const Hdf5Type& type() const { return type_; }
  /// Count of numbers per index of the first dimension, and in total.
  std::uint64_t row_size() const { return row_size_; }
  std::uint64_t size() const { return size_; }

  /// Reads rows of the first dimension from `first` on, as many as fit into `values`. Several
  /// threads may call it. Throws IoError if the content is damaged. \pre the dataset has these rows
  void read(std::uint64_t first, std::span<double> values) const;
  /// Reads all numbers in C order.
  std::vector<double> values() const;

  /// Throws IoError with the name of the dataset.
  [[noreturn]] void fail(const std::string& message) const;

  /// Source of the bytes of rows.
  class Storage {
   public:
    virtual ~Storage() = default;
    virtual void read_rows(std::uint64_t first, std::uint64_t rows, char* to) const = 0;
  };

 private:
  std::shared_ptr<const Hdf5Bytes> file_;
  std::string name_;
  std::vector<std::uint64_t> shape_;
  Hdf5Type type_;
  std::uint64_t row_size_ = 1;
  std::uint64_t size_ = 1;
  std::shared_ptr<const Storage> storage_;
};

/// Top group of an HDF5 file.
class Hdf5File {
 public:
  /// Throws IoError if the file is missing, a folder, not HDF5, truncated or damaged.
  explicit Hdf5File(const std::filesystem::path& path);

  const std::string& path() const { return bytes_->path(); }
  /// Names in the top group, in alphabetical order.
  std::vector<std::string> names() const;
  bool has(const std::string& name) const { return links_.contains(name); }
  /// Returns a dataset. Throws IoError, also for links to elsewhere, which are not followed.
  Hdf5Dataset dataset(const std::string& name) const;

  bool has_attribute(const std::string& name) const { return attributes_.contains(name); }
  /// Value of an attribute, or `otherwise` if it is missing. Throws IoError unless it is one finite
  /// number.
  double attribute(const std::string& name, double otherwise) const;

  /// Throws IoError.
  [[noreturn]] void fail(const std::string& message) const { bytes_->fail(message); }

 private:
  void add_attribute(const Hdf5Message& message);

  std::shared_ptr<const Hdf5Bytes> bytes_;
  /// Address of each object's header; none for links to elsewhere.
  std::map<std::string, std::optional<std::uint64_t>> links_;
  /// Values of attributes; none if the attribute is not a single number.
  std::map<std::string, std::optional<double>> attributes_;
};

}  // namespace mimetra
