#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

class PendingOutputs;

enum class VtpCompression { lz4, zlib };

/// As people choose it.
constexpr std::string_view choice_name(VtpCompression value) {
  switch (value) {
    case VtpCompression::lz4:
      return "fast";
    case VtpCompression::zlib:
      return "small";
  }
  return {};
}

struct VtpOptions {
  VtpCompression compression = VtpCompression::lz4;
  bool overwrite = false;
  /// Files and folders that were read, which must stay.
  std::vector<std::filesystem::path> inputs = {};
  /// Outputs that it appears together with; alone without.
  PendingOutputs* together = nullptr;

  static constexpr Option kCompression{"compression", &VtpOptions::compression};
  static constexpr Option kOverwrite{"overwrite", &VtpOptions::overwrite};
  static constexpr auto declared() { return std::tuple(kCompression, kOverwrite); }
};

/// Writes a sequence with its fields for ParaView: `NAME.pvd` and `NAME.vtp.series` beside a folder
/// `NAME_vtp` of `NAME_0000.vtp` ..., positions float32, compressed binary, 32-bit ids, times in
/// seconds, the user's polygons (triangle fields on the polygon: the largest of its triangles).
/// Given NAME.vtp, only the first frame, in one file. Atomic: the .pvd appears last. Returns the
/// files written, the one asked for first. Throws OutputError; std::invalid_argument for a field
/// whose size is not the mesh's, for two fields of one name, and for a target that is neither .pvd
/// nor .vtp.
std::vector<std::filesystem::path> write_vtp_series(const FieldSequence& fields,
                                                    const std::filesystem::path& target,
                                                    const VtpOptions& = {},
                                                    const Context& context = {});

struct VtpReadOptions {
  /// Chooses frames, 0-based, from their number; all without.
  std::function<std::vector<int>(int count)> selected = {};
  /// False to take none, and to look into no further file for them.
  bool fields = true;

  static constexpr Option kFields{"fields", &VtpReadOptions::fields};
  static constexpr auto declared() { return std::tuple(kFields); }
};

/// A series as write_vtp_series writes it, and ParaView too: NAME.pvd, NAME.vtp.series, or one
/// NAME.vtp. Fields are those that all chosen frames have and that do not change over them, for
/// which each is read once; others are left out, which is noted (those that only some have and the
/// first has not where DisplacedRest looks). `displacement` gives the rest pose, and is not a
/// field, where DisplacedRest finds one. The other frames are read when they are needed, which
/// throws as this does: IoError that names the file, MismatchError if a frame has other vertices or
/// faces (they may come in another order or be cut otherwise, if none is flipped), Cancelled.
FieldSequence open_vtp_series(const std::filesystem::path& path, const VtpReadOptions& = {},
                              const Context& context = {});

/// The same with all frames in memory.
FieldSequence read_vtp_series(const std::filesystem::path& path, const VtpReadOptions& = {},
                              const Context& context = {});

/// The files that open_vtp_series reads for a path: itself, and the frames it names.
std::vector<std::filesystem::path> vtp_series_files(const std::filesystem::path& path);

/// A field on the vertices of a .vtp file (N x c). Throws IoError where the file or field is
/// missing.
Eigen::MatrixXd read_vtp_field(const std::filesystem::path& path, const std::string& name);

/// The same; nothing where the field is missing.
std::optional<Eigen::MatrixXd> find_vtp_field(const std::filesystem::path& path,
                                              const std::string& name);

}  // namespace mimetra
