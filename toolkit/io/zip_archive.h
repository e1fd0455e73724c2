#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "toolkit/io/binary_file.h"

/// ZIP archives, by libzip. Internal to the formats that are such archives.
namespace mimetra {

struct OpenZip;

class ZipReader {
 public:
  /// Throws IoError.
  explicit ZipReader(const std::filesystem::path& path);
  ~ZipReader();

  /// Names of the members, in the archive's order.
  std::vector<std::string> names() const;
  /// A member's bytes, as large as the archive says; one that is stored as it is is read in parts,
  /// a compressed one is kept in memory, all of it once more than its first 128 kB are read. They
  /// outlive the reader. Throws IoError.
  std::unique_ptr<const InputBytes> member(const std::string& name) const;

 private:
  std::shared_ptr<OpenZip> zip_;
};

class ZipWriter {
 public:
  /// Throws OutputError.
  explicit ZipWriter(std::filesystem::path path);
  ~ZipWriter();
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  /// Add a member, not compressed and without the time of writing. Throw OutputError.
  void add(const std::string& name, std::string bytes);
  void add_file(const std::string& name, const std::filesystem::path& file);
  /// Writes the archive. Throws OutputError.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
