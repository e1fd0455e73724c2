#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>
#include <type_traits>

#include "plugins/c/mimetra.h"

/// Structs, texts and errors that cross the C interface.
namespace mimetra {

/// Copies a struct of the C interface. Fields past its struct_size, which an older header lacks,
/// are zero. A field that struct_size cuts through is zero as well.
template <typename Struct>
Struct whole(const Struct& given) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  Struct copy{};
  const std::size_t size = given.struct_size / alignof(Struct) * alignof(Struct);
  std::memcpy(&copy, &given, std::min(size, sizeof copy));
  return copy;
}

/// True for one line of UTF-8, as in messages, names and JSON.
bool is_line(std::string_view text);

/// True for lines of UTF-8, which may contain tabs.
bool is_text(std::string_view text);

/// Returns lines of UTF-8 unchanged. In other text, '?' replaces bytes except printable ASCII.
std::string printable(const std::string& text);

/// Form of an exception in the C interface.
struct Failure {
  mimetra_status status;
  std::string message;
};

Failure failure_of(const std::exception_ptr& error);

/// Throws the exception of `status`. The message begins with `subject`, which failed.
[[noreturn]] void throw_failure(mimetra_status status, const std::string& subject,
                                const std::string& message);

}  // namespace mimetra
