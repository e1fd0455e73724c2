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

/// Named arrays from a caller, which make up a value. Shapes are written as in the header, "F x N x
/// 3". A letter is a size that all arrays share, and a number is a fixed size. Errors name the
/// value and the array. Functions throw UsageError if an array is missing or has another type or
/// rank, MismatchError if sizes differ, and IoError for impossible values.
class GivenArrays {
 public:
  /// `subject` names the value in messages. Throws UsageError for an invalid array.
  GivenArrays(std::string subject, const mimetra_array* const* arrays);

  const std::string& subject() const { return subject_; }
  /// Arrays in the order of the caller.
  const std::vector<mimetra_array>& all() const { return arrays_; }
  /// Looks up an array by name. Here and below, fields, which have a location, are ignored.
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// Empty if there is no such array.
  std::vector<std::int64_t> shape(std::string_view name) const;
  /// Size for a letter. \pre An array with that letter was read.
  int size(char letter) const { return static_cast<int>(sizes_.at(letter).first); }
  /// Fixes the size for a letter before an array does. `where` is its origin for messages.
  void set_size(char letter, int size, const std::string& where);

  /// Rows are the first size, columns the product of all others.
  Frames numbers(std::string_view name, std::string_view shape, bool finite = true);
  /// Reads an array out of all().
  Frames numbers(const mimetra_array& array, std::string_view shape, bool finite);
  Eigen::VectorXd vector(std::string_view name, std::string_view shape, bool finite = true);
  Positions positions(std::string_view name);
  std::vector<int> integers(std::string_view name, std::string_view shape);
  std::vector<std::uint8_t> bytes(std::string_view name, std::string_view shape);
  std::vector<std::string> strings(std::string_view name, std::string_view shape);
  /// Only string of an array, which may have several lines.
  std::string text(std::string_view name);

  /// Throws UsageError for an array that nothing has read, unless its name is in `shown`. Those are
  /// the arrays that values of the kind only show.
  void check_all_used(const std::set<std::string, std::less<>>& shown) const;

 private:
  const mimetra_array* find(std::string_view name) const;
  const mimetra_array& get(std::string_view name, std::string_view shape);
  /// Checks the shape and marks the array as read.
  void match(const mimetra_array& array, std::string_view shape);
  Frames values_of(const mimetra_array& array, bool finite) const;
  [[noreturn]] void refuse_location(std::string_view name) const;
  std::string place(std::string_view name) const;

  std::string subject_;
  std::vector<mimetra_array> arrays_;
  std::map<char, std::pair<std::int64_t, std::string>> sizes_;
  std::set<const mimetra_array*> used_;
};

/// True if two arrays exclude each other: same name, same part of the mesh.
bool is_same_place(const mimetra_array& a, const mimetra_array& b);

}  // namespace mimetra
