#include "toolkit/cli/exit_code.h"

#include <memory>
#include <new>
#include <ostream>
#include <stdexcept>

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/option_words.h"

namespace mimetra::cli {

std::string terminal_text(std::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    const char first = text.front();
    const std::size_t size = first == '\n' || first == '\t' ? 1 : printable_bytes(text);
    if (size > 0) {
      result += text.substr(0, size);
    } else {
      const auto byte = static_cast<unsigned char>(text.front());
      result += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 0xfU]};
    }
    text.remove_prefix(size > 0 ? size : 1);
  }
  return result;
}

namespace {

ExitCode fail(ExitCode code, const std::exception& error) {
  spdlog::error(terminal_text(with_options_spelled(error.what(), spelled_for_command)));
  return code;
}

}  // namespace

void say_to(std::ostream& stream) {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "mimetra", std::make_shared<spdlog::sinks::ostream_sink_st>(stream, true)));
  spdlog::set_pattern("%n: %l: %v");
}

ExitCode exit_code_of(const std::function<void()>& run) {
  try {
    run();
    return kDone;
  } catch (const UsageError& error) {
    return fail(kUsage, error);
  } catch (const MismatchError& error) {
    return fail(kMismatch, error);
  } catch (const IoError& error) {
    return fail(kBadInput, error);
  } catch (const OutputError& error) {
    return fail(kOutput, error);
  } catch (const Cancelled& error) {
    return fail(kInterrupted, error);
  } catch (const std::invalid_argument& error) {
    return fail(kUsage, error);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return fail(kFailed, error);
  }
}

}  // namespace mimetra::cli
