#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "plugins/c/mimetra.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Named arrays that make up a value, as a caller hands them over.
///
/// Shapes are asked for as the header writes them, "F x N x 3": a letter stands for the same size
/// in every array, a number for itself. Errors name the value and the array: UsageError for an
/// array that is missing or of another kind, MismatchError for sizes that differ, IoError for
/// values that cannot be.
class GivenArrays {
 public:
  /// `subject` is what the value is called in messages. Throws UsageError for an array that is
  /// none.
  GivenArrays(std::string subject, const mimetra_array* const* arrays);

  const std::string& subject() const { return subject_; }
  /// In the order they came.
  const std::vector<mimetra_array>& all() const { return arrays_; }
  /// By name; fields, which have a location, are not meant here or below.
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// Empty where there is none of that name.
  std::vector<std::int64_t> shape(std::string_view name) const;
  /// The size that a letter stands for. \pre an array with it was asked for
  int size(char letter) const { return static_cast<int>(sizes_.at(letter).first); }
  /// Says what a letter stands for before any array does.
  void set_size(char letter, int size, const std::string& where);

  /// Rows by the first size, columns by all others.
  Frames numbers(std::string_view name, std::string_view shape, bool finite = true);
  /// One of all().
  Frames numbers(const mimetra_array& array, std::string_view shape, bool finite);
  Eigen::VectorXd vector(std::string_view name, std::string_view shape, bool finite = true);
  Positions positions(std::string_view name);
  std::vector<int> integers(std::string_view name, std::string_view shape);
  std::vector<std::uint8_t> bytes(std::string_view name, std::string_view shape);
  std::vector<std::string> strings(std::string_view name, std::string_view shape);
  /// The only string of an array, of any number of lines.
  std::string text(std::string_view name);

  /// Throws UsageError for an array that nothing asked for, unless it is in `shown`: those that
  /// values of the kind show besides.
  void check_all_used(const std::set<std::string, std::less<>>& shown) const;

 private:
  const mimetra_array* find(std::string_view name) const;
  const mimetra_array& get(std::string_view name, std::string_view shape);
  /// Checks the shape, and keeps in mind that the array was asked for.
  void match(const mimetra_array& array, std::string_view shape);
  Frames values_of(const mimetra_array& array, bool finite) const;
  [[noreturn]] void refuse_location(std::string_view name) const;
  std::string place(std::string_view name) const;

  std::string subject_;
  std::vector<mimetra_array> arrays_;
  std::map<char, std::pair<std::int64_t, std::string>> sizes_;
  std::set<const mimetra_array*> used_;
};

/// True for two arrays that one value cannot have both: of one name, on the same part of the mesh.
bool is_same_place(const mimetra_array& a, const mimetra_array& b);

}  // namespace mimetra
