#include "plugins/c/given_arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plugins/c/crossing.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {

namespace {

static_assert(sizeof(int) == sizeof(std::int32_t) && sizeof(float) == 4 && sizeof(double) == 8);

std::vector<std::int64_t> shape_of(const mimetra_array& array) {
  return {array.shape, array.shape + array.rank};
}

std::int64_t count_of(const mimetra_array& array) {
  std::int64_t count = 1;
  for (const std::int64_t size : shape_of(array)) count *= size;
  return count;
}

std::string shape_text(const mimetra_array& array) {
  std::string text;
  for (const std::int64_t size : shape_of(array)) {
    text += (text.empty() ? "" : " x ") + std::to_string(size);
  }
  return text;
}

/// Letters and numbers of "F x N x 3".
std::vector<std::string> sizes_in(std::string_view shape) {
  std::vector<std::string> sizes;
  while (!shape.empty()) {
    const auto end = std::min(shape.find(" x "), shape.size());
    sizes.emplace_back(shape.substr(0, end));
    shape.remove_prefix(std::min(end + 3, shape.size()));
  }
  return sizes;
}

/// Reason why an array is unusable; empty if there is none.
std::string problem_of(const mimetra_array& array) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (array.type < MIMETRA_F64 || array.type > MIMETRA_STRING) {
    return "has the type " + std::to_string(array.type) + ", which is none of mimetra.h";
  }
  if (array.rank < 1 || array.rank > 4) {
    return "has the rank " + std::to_string(array.rank) + ", expected 1 to 4";
  }
  std::int64_t count = 1;
  for (const std::int64_t size : shape_of(array)) {
    const bool fits = size >= 0 && size <= kMost &&
                      (size == 0 || count <= std::numeric_limits<std::ptrdiff_t>::max() / 8 / size);
    if (!fits) return "has the shape " + shape_text(array) + ", which no memory holds";
    count *= size;
  }
  return count > 0 && !array.values ? "has no values" : "";
}

/// Sizes that may be 0: regions and rows, expressions, identities, landmarks, corners, polygons,
/// triangles, energies.
constexpr std::string_view kMayBeNone = "RDILCPTE";

template <typename To, typename From>
void copy_as(const void* from, std::int64_t count, To* to) {
  std::copy_n(static_cast<const From*>(from), count, to);
}

const char* type_name(int type) {
  constexpr const char* kNames[] = {"", "F64", "F32", "I32", "U8", "STRING"};
  return kNames[type];
}

}  // namespace

bool is_same_place(const mimetra_array& a, const mimetra_array& b) {
  return a.location == b.location && std::string_view(a.name) == b.name;
}

GivenArrays::GivenArrays(std::string subject, const mimetra_array* const* arrays)
    : subject_(std::move(subject)) {
  for (; arrays && *arrays; ++arrays) {
    const mimetra_array array = whole(**arrays);
    if (!array.name || !*array.name || !is_line(array.name)) {
      throw UsageError(subject_ + ": array " + std::to_string(arrays_.size()) +
                       " has no name; are its struct_size and name set?");
    }
    const bool is_twice = std::ranges::any_of(
        arrays_, [&array](const mimetra_array& other) { return is_same_place(array, other); });
    if (is_twice) throw UsageError(place(array.name) + "is given twice");
    if (array.location < MIMETRA_NOWHERE || array.location > MIMETRA_ON_TRIANGLES) {
      throw UsageError(place(array.name) + "has the location " + std::to_string(array.location) +
                       ", which is none of mimetra.h");
    }
    const std::string problem = problem_of(array);
    if (!problem.empty()) throw UsageError(place(array.name) + problem);
    arrays_.push_back(array);
  }
}

std::string GivenArrays::place(std::string_view name) const {
  return subject_ + ": array '" + std::string(name) + "' ";
}

const mimetra_array* GivenArrays::find(std::string_view name) const {
  const auto found = std::ranges::find_if(arrays_, [name](const mimetra_array& array) {
    return array.location == MIMETRA_NOWHERE && array.name == name;
  });
  return found == arrays_.end() ? nullptr : &*found;
}

std::vector<std::int64_t> GivenArrays::shape(std::string_view name) const {
  const mimetra_array* array = find(name);
  return array ? shape_of(*array) : std::vector<std::int64_t>();
}

void GivenArrays::set_size(char letter, int size, const std::string& where) {
  sizes_.try_emplace(letter, size, where);
}

void GivenArrays::match(const mimetra_array& array, std::string_view shape) {
  used_.insert(&array);
  const std::vector<std::string> expected = sizes_in(shape);
  const auto refuse = [&] {
    throw UsageError(place(array.name) + "is " + shape_text(array) + ", expected " +
                     std::string(shape));
  };
  if (static_cast<int>(expected.size()) != array.rank) refuse();
  for (int i = 0; i < array.rank; ++i) {
    const std::string& size = expected[static_cast<std::size_t>(i)];
    const std::int64_t found = array.shape[i];
    if (found == 0 && kMayBeNone.find(size[0]) == std::string_view::npos) {
      throw IoError(subject_, "array '" + std::string(array.name) + "' is " + shape_text(array) +
                                  ", expected " + std::string(shape) + " with " + size +
                                  " at least 1");
    }
    if (std::isdigit(static_cast<unsigned char>(size[0]))) {
      if (std::to_string(found) != size) refuse();
      continue;
    }
    const auto [known, is_new] =
        sizes_.try_emplace(size[0], found, "'" + std::string(array.name) + "'");
    if (!is_new && known->second.first != found) {
      throw MismatchError(place(array.name) + "is " + shape_text(array) + ", expected " +
                          std::string(shape) + " with " + size + " = " +
                          std::to_string(known->second.first) + " as in " + known->second.second);
    }
  }
}

void GivenArrays::refuse_location(std::string_view name) const {
  throw UsageError(place(name) + "has a location, which only fields have");
}

const mimetra_array& GivenArrays::get(std::string_view name, std::string_view shape) {
  const mimetra_array* array = find(name);
  if (!array) {
    const auto named = [name](const mimetra_array& other) { return other.name == name; };
    if (std::ranges::any_of(arrays_, named)) refuse_location(name);
    throw UsageError(subject_ + ": needs the array '" + std::string(name) + "' (" +
                     std::string(shape) + ")");
  }
  match(*array, shape);
  return *array;
}

Frames GivenArrays::numbers(std::string_view name, std::string_view shape, bool finite) {
  return values_of(get(name, shape), finite);
}

Frames GivenArrays::numbers(const mimetra_array& array, std::string_view shape, bool finite) {
  match(array, shape);
  return values_of(array, finite);
}

Frames GivenArrays::values_of(const mimetra_array& array, bool finite) const {
  const std::string_view name = array.name;
  if (array.type == MIMETRA_STRING) {
    throw UsageError(place(name) + "is STRING, expected F64 or F32");
  }
  const std::int64_t count = count_of(array);
  const std::int64_t rows = array.shape[0];
  Frames matrix(rows, rows > 0 ? count / rows : 0);
  switch (array.type) {
    case MIMETRA_F64:
      copy_as<double, double>(array.values, count, matrix.data());
      break;
    case MIMETRA_F32:
      copy_as<double, float>(array.values, count, matrix.data());
      break;
    case MIMETRA_I32:
      copy_as<double, std::int32_t>(array.values, count, matrix.data());
      break;
    default:
      copy_as<double, std::uint8_t>(array.values, count, matrix.data());
  }
  if (!finite || matrix.allFinite()) return matrix;
  const double* bad = std::find_if(matrix.data(), matrix.data() + count,
                                   [](double value) { return !std::isfinite(value); });
  std::int64_t rest = bad - matrix.data();
  std::string index;
  for (int i = array.rank; i-- > 0; rest /= array.shape[i]) {
    index = std::to_string(rest % array.shape[i]) + (index.empty() ? "" : ", ") + index;
  }
  throw IoError(subject_, "array '" + std::string(name) + "' holds " + std::to_string(*bad) +
                              " at [" + index + "], expected a finite number");
}

Eigen::VectorXd GivenArrays::vector(std::string_view name, std::string_view shape, bool finite) {
  const Frames matrix = numbers(name, shape, finite);
  return Eigen::Map<const Eigen::VectorXd>(matrix.data(), matrix.size());
}

Positions GivenArrays::positions(std::string_view name) {
  return numbers(name, "N x 3");
}

std::vector<int> GivenArrays::integers(std::string_view name, std::string_view shape) {
  const mimetra_array& array = get(name, shape);
  std::vector<int> values(static_cast<std::size_t>(count_of(array)));
  if (array.type == MIMETRA_I32) {
    copy_as<int, std::int32_t>(array.values, count_of(array), values.data());
  } else if (array.type == MIMETRA_U8) {
    copy_as<int, std::uint8_t>(array.values, count_of(array), values.data());
  } else {
    throw UsageError(place(name) + "is " + type_name(array.type) + ", expected I32");
  }
  return values;
}

std::vector<std::uint8_t> GivenArrays::bytes(std::string_view name, std::string_view shape) {
  const mimetra_array& array = get(name, shape);
  if (array.type != MIMETRA_U8) {
    throw UsageError(place(name) + "is " + type_name(array.type) + ", expected U8");
  }
  std::vector<std::uint8_t> values(static_cast<std::size_t>(count_of(array)));
  copy_as<std::uint8_t, std::uint8_t>(array.values, count_of(array), values.data());
  return values;
}

std::vector<std::string> GivenArrays::strings(std::string_view name, std::string_view shape) {
  const mimetra_array& array = get(name, shape);
  if (array.type != MIMETRA_STRING) {
    throw UsageError(place(name) + "is " + type_name(array.type) + ", expected STRING");
  }
  std::vector<std::string> values;
  for (std::int64_t i = 0; i < count_of(array); ++i) {
    const char* text = static_cast<const char* const*>(array.values)[i];
    if (!text || !is_line(text)) {
      throw UsageError(place(name) + "holds no line of UTF-8 at [" + std::to_string(i) + "]");
    }
    values.emplace_back(text);
  }
  return values;
}

std::string GivenArrays::text(std::string_view name) {
  const mimetra_array& array = get(name, "1");
  if (array.type != MIMETRA_STRING) {
    throw UsageError(place(name) + "is " + type_name(array.type) + ", expected STRING");
  }
  const char* text = *static_cast<const char* const*>(array.values);
  if (!text || !is_text(text)) throw UsageError(place(name) + "holds no UTF-8");
  return text;
}

void GivenArrays::check_all_used(const std::set<std::string, std::less<>>& shown) const {
  for (const mimetra_array& array : arrays_) {
    const std::string_view name = array.name;
    if (used_.contains(&array) || shown.contains(name)) continue;
    if (array.location != MIMETRA_NOWHERE) refuse_location(name);
    throw UsageError(place(name) +
                     "is not known here; mimetra.h lists those of each kind, and a field needs a "
                     "location");
  }
}

}  // namespace mimetra
