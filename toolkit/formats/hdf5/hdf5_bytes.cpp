#include "toolkit/formats/hdf5/hdf5_bytes.h"

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view kHdf5Magic{"\x89HDF\r\n\x1a\n", 8};

const fs::path& checked_file(const fs::path& path) {
  std::error_code unreadable;
  const auto status = fs::status(path, unreadable);
  if (!fs::exists(status)) throw IoError(path.string(), "no such file");
  if (fs::is_directory(status)) throw IoError(path.string(), "is a folder, expected an HDF5 file");
  return path;
}

}  // namespace

Hdf5Bytes::Hdf5Bytes(const fs::path& path) : path_(path.string()), file_(checked_file(path)) {
  if (!holds(0, kHdf5Magic.size()) || at(0, kHdf5Magic.size()) != kHdf5Magic) {
    fail("is not an HDF5 file, or is truncated");
  }
}

void Hdf5Bytes::read(std::uint64_t address, char* to, std::size_t bytes) const {
  if (!holds(address, bytes)) fail_damaged("a part of it lies outside of it");
  file_.read(address, to, bytes);
}

std::string Hdf5Bytes::at(std::uint64_t address, std::uint64_t bytes) const {
  if (!holds(address, bytes)) fail_damaged("a part of it lies outside of it");
  std::string content(bytes, '\0');
  read(address, content.data(), content.size());
  return content;
}

void Hdf5Bytes::fail(const std::string& message) const {
  throw IoError(path_, message);
}

void Hdf5Bytes::fail_damaged(const std::string& what) const {
  fail("is a damaged HDF5 file, or is truncated: " + what);
}

std::string_view Hdf5Fields::take(std::uint64_t bytes) {
  if (bytes > left_.size()) file_.fail_damaged("a header ends early");
  const std::string_view taken = left_.substr(0, bytes);
  left_.remove_prefix(bytes);
  return taken;
}

std::uint64_t Hdf5Fields::number(std::size_t bytes) {
  const std::string_view taken = take(bytes);
  std::uint64_t value = 0;
  for (std::size_t i = bytes; i > 0; --i) {
    value = value << 8 | static_cast<unsigned char>(taken[i - 1]);
  }
  return value;
}

}  // namespace mimetra
