#include "plugins/c/crossing.h"

#include <algorithm>
#include <new>

#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"
#include "toolkit/operations/option_words.h"

namespace mimetra {

namespace {

bool is_utf8(std::string_view text) {
  try {
    // Only serialising detects text that is not UTF-8.
    return !nlohmann::json(text).dump().empty();
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

bool is_control(unsigned char c) {
  return c < 0x20 || c == 0x7f;
}

}  // namespace

bool is_line(std::string_view text) {
  return std::ranges::none_of(text, is_control) && is_utf8(text);
}

bool is_text(std::string_view text) {
  const auto is_odd = [](unsigned char c) { return is_control(c) && c != '\n' && c != '\t'; };
  return std::ranges::none_of(text, is_odd) && is_utf8(text);
}

std::string printable(const std::string& text) {
  if (is_text(text)) return text;
  std::string ascii = text;
  const auto is_odd = [](unsigned char c) { return (is_control(c) && c != '\n') || c > 0x7e; };
  std::ranges::replace_if(ascii, is_odd, '?');
  return ascii;
}

namespace {

Failure in_own_words(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const MismatchError& mismatch) {
    return {MIMETRA_MISMATCH, mismatch.what()};
  } catch (const std::invalid_argument& usage) {
    return {MIMETRA_USAGE, usage.what()};
  } catch (const IoError& input) {
    return {MIMETRA_BAD_INPUT, input.what()};
  } catch (const OutputError& output) {
    return {MIMETRA_BAD_OUTPUT, output.what()};
  } catch (const Cancelled& cancelled) {
    return {MIMETRA_CANCELLED, cancelled.what()};
  } catch (const std::bad_alloc&) {
    return {MIMETRA_FAILED, "not enough memory"};
  } catch (const std::exception& other) {
    return {MIMETRA_FAILED, other.what()};
  } catch (...) {
    return {MIMETRA_FAILED, "something that is no std::exception was thrown"};
  }
}

}  // namespace

Failure failure_of(const std::exception_ptr& error) {
  Failure failure = in_own_words(error);
  failure.message = with_options_spelled(failure.message, spelled_for_library);
  return failure;
}

void throw_failure(mimetra_status status, const std::string& subject, const std::string& message) {
  const std::string text = subject + ": " + message;
  switch (status) {
    case MIMETRA_FAILED:
      throw std::runtime_error(text);
    case MIMETRA_USAGE:
      throw UsageError(text);
    case MIMETRA_BAD_INPUT:
      throw IoError(subject, message);
    case MIMETRA_MISMATCH:
      throw MismatchError(text);
    case MIMETRA_BAD_OUTPUT:
      throw OutputError(subject, message);
    case MIMETRA_CANCELLED:
      throw Cancelled();
    default:
      throw std::runtime_error(subject + ": returned the status " + std::to_string(status) +
                               ", which is none of mimetra.h");
  }
}

}  // namespace mimetra
