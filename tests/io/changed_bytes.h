#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <gmock/gmock.h>

#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {

/// Whatever bytes of a sound file are changed, the sequence is read, or refused by an error that
/// names the file.
inline void expect_harmless_changes(const std::string& sound, const std::filesystem::path& file) {
  std::uint32_t random = 1;
  const auto next = [&random](std::size_t below) {
    random = 1664525 * random + 1013904223;  // Numerical Recipes
    return static_cast<std::size_t>(random >> 8) % below;
  };
  constexpr std::string_view kTelling = "0123456789-.,:[]{}()\"e ";
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = sound;
    for (std::size_t change = next(4) + 1; change > 0; --change) {
      const bool is_text = next(2) == 0;
      bytes[next(bytes.size())] =
          is_text ? kTelling[next(kTelling.size())] : static_cast<char>(next(256));
    }
    write_bytes(file, bytes);
    try {
      read_sequence(file.string());
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(file.filename().string()));
    }
  }
}

}  // namespace mimetra::test
