#include "toolkit/operations/file_hash.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

// Of its header alone: who links this library need not find another.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace mimetra {

std::string file_hash(const std::filesystem::path& path) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return "";
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return "";
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       XXH3_freeState);
  if (!state) throw std::bad_alloc();
  XXH3_64bits_reset(state.get());
  std::vector<char> buffer(1 << 20);
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    XXH3_64bits_update(state.get(), buffer.data(), static_cast<std::size_t>(stream.gcount()));
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(XXH3_64bits_digest(state.get())));
  return text;
}

std::uint64_t hash_of_ends(const std::filesystem::path& path) {
  constexpr std::uint64_t kEnd = 1 << 16;
  std::error_code unreadable;
  const std::uint64_t size = std::filesystem::file_size(path, unreadable);
  if (unreadable) return 0;
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> ends(static_cast<std::size_t>(std::min(size, 2 * kEnd)));
  const auto half = static_cast<std::streamsize>(std::min(size, kEnd));
  const auto rest = static_cast<std::streamsize>(ends.size()) - half;
  stream.read(ends.data(), half);
  stream.seekg(-rest, std::ios::end);
  stream.read(ends.data() + half, rest);
  return stream ? XXH3_64bits_withSeed(ends.data(), ends.size(), size) : 0;
}

}  // namespace mimetra
