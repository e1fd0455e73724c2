#include "toolkit/io/hdf5_bytes.h"

#include <string_view>

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

}  // namespace mimetra
