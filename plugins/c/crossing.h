#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>
#include <type_traits>

#include "plugins/c/mimetra.h"

/// What crosses the C interface: structs, text and errors.
namespace mimetra {

/// A struct of the C interface as it was given: fields past its struct_size, which the giver's
/// header did not have, are zero. No struct ends within a field: of such a size that field is zero.
template <typename Struct>
Struct whole(const Struct& given) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  Struct copy{};
  const std::size_t size = given.struct_size / alignof(Struct) * alignof(Struct);
  std::memcpy(&copy, &given, std::min(size, sizeof copy));
  return copy;
}

/// True for UTF-8 in one line: what stands in messages, names and JSON.
bool is_line(std::string_view text);

/// True for lines of UTF-8, in which tabs may stand too.
bool is_text(std::string_view text);

/// `text` where it is lines of UTF-8; otherwise with '?' for each byte that is not printable ASCII.
std::string printable(const std::string& text);

/// What an exception is on the other side of the C interface.
struct Failure {
  mimetra_status status;
  std::string message;
};

Failure failure_of(const std::exception_ptr& error);

/// Throws what `status` stands for, with `subject` (who failed) before the message.
[[noreturn]] void throw_failure(mimetra_status status, const std::string& subject,
                                const std::string& message);

}  // namespace mimetra
