#include "toolkit/io/sequence_companions.h"

#include <utility>

#include "toolkit/io/frame_files.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/written_files.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

constexpr const char* kCorrespondenceSuffix = ".correspondence.json";

bool is_there(const fs::path& path) {
  std::error_code unreadable;
  return fs::exists(path, unreadable);
}

/// What follows the name in a second file of a format.
std::vector<std::string> own_suffixes_of(const fs::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".gltf") return {".bin"};
  if (extension == ".pvd") return {".vtp.series"};
  return {};
}

/// The same in those of the files that a sequence may be written with.
std::vector<std::string> suffixes_of(const fs::path& sequence) {
  std::vector<std::string> suffixes = {kCorrespondenceSuffix};
  const std::string extension = lower_extension(sequence);
  const SequenceFormat* format = sequence_format(sequence);
  if (extension.empty()) suffixes.clear();  // a folder holds it
  if (extension.empty() || (format && format->has_companions)) {
    suffixes.insert(suffixes.end(), {kRestSuffix, kTimesSuffix});
  }
  if (format && format->has_companions) suffixes.emplace_back(kTopologySuffix);
  for (std::string& own : own_suffixes_of(sequence)) suffixes.push_back(std::move(own));
  return suffixes;
}

std::vector<std::string> refused_beside(const fs::path& file,
                                        const std::vector<std::string>& suffixes, bool overwrite) {
  const fs::path main = file.has_filename() ? file : file.parent_path();
  std::vector<std::string> refused;
  for (const std::string& suffix : suffixes) {
    const bool has_owner =
        suffix == kRestSuffix || suffix == kTimesSuffix || suffix == kTopologySuffix;
    const fs::path path =
        has_owner ? beside(file, suffix) : fs::path(main).replace_extension(suffix);
    if (!is_there(path)) continue;
    const std::string reason =
        why_to_keep(main, has_owner ? other_of_name(file) : fs::path(), overwrite);
    if (reason.empty()) continue;
    refused.push_back(path.string() + ": " + reason +
                      "; a run that writes another content there is refused");
  }
  return refused;
}

}  // namespace

fs::path other_of_name(const fs::path& sequence) {
  const fs::path name = beside(sequence, ""), own = sequence.lexically_normal();
  std::vector<fs::path> others;
  if (is_there(name / kFolderManifest) && own != name && own != name / "") others.push_back(name);
  for (const SequenceFormat& format : sequence_formats()) {
    if (!format.has_companions) continue;
    for (const std::string& extension : format.extensions) {
      const fs::path other = name.string() + extension;
      if (other != own && is_there(other)) others.push_back(other);
    }
  }
  return others.empty() ? fs::path() : others.front();
}

std::vector<std::string> refused_companions(const fs::path& sequence, bool overwrite) {
  return refused_beside(sequence, suffixes_of(sequence), overwrite);
}

std::vector<std::string> refused_parts(const fs::path& file, bool overwrite, bool may_be_paired) {
  std::vector<std::string> suffixes = own_suffixes_of(file);
  if (may_be_paired && !lower_extension(file).empty()) suffixes.emplace_back(kCorrespondenceSuffix);
  return refused_beside(file, suffixes, overwrite);
}

}  // namespace mimetra
