#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/frame_source.h"

/// Formats of meshes by their names, what files hold, and what float32 makes of positions.
namespace mimetra {

enum class MeshFormat { ply, obj, off, stl, om };

/// As people choose it; with a dot before it, its extension.
constexpr std::string_view choice_name(MeshFormat value) {
  switch (value) {
    case MeshFormat::ply:
      return "ply";
    case MeshFormat::obj:
      return "obj";
    case MeshFormat::off:
      return "off";
    case MeshFormat::stl:
      return "stl";
    case MeshFormat::om:
      return "om";
  }
  return {};
}

/// True for an extension (".obj") of a mesh format, in any case.
bool is_mesh_extension(const std::string& extension);
/// All of them, in lower case.
std::vector<std::string> mesh_extensions();
/// What is wrong with an extension in lower case that is_mesh_extension() refuses.
std::string unknown_mesh_extension(const std::string& extension);

/// What the files of a format have a place for besides poses and triangles, declared once with the
/// format. What stands in files beside them (NAME.rest.ply, NAME.topology.ply) counts.
struct HeldParts {
  enum class Texture { none, vertices, corners };

  /// Faces of more than three corners.
  bool polygons = false;
  /// Texture coordinates: none, one for each vertex, or one for each corner of a face.
  Texture texture = Texture::none;
  /// Faces without texture coordinates where others have them.
  bool bare_faces = true;
  /// Groups, and which material a face has.
  bool groups = false;
  /// A rest pose that is no frame.
  bool rest = true;
  /// Vertices in their order; otherwise they are numbered anew.
  bool vertex_order = true;
  /// Times at all.
  bool times = true;
  /// Times that are not evenly apart, where other programs find them.
  bool uneven_times = true;
  /// Times as they are; otherwise in single precision.
  bool exact_times = true;
  /// Positions in double precision where single precision would round motion that one sees, or not
  /// at all there; otherwise rounded.
  bool exact_positions = true;

  bool operator==(const HeldParts&) const = default;
};

/// "polygons, UVs per corner, groups, rest pose": what `held` says, for lists of formats.
std::string description(const HeldParts& held);

/// What a format leaves out of a sequence, in words such as "texture coordinates"; none where it
/// holds all. Reads one frame where the rest pose may be equal to it.
std::vector<std::string> parts_left_out(const HeldParts& held, const FrameSource& sequence);

/// The fields in a mesh file.
struct FieldsRead {
  std::vector<Field> fields = {};
  /// What of it is no field, for notes: names of properties.
  std::vector<std::string> left_out = {};
};

/// The largest number of single precision.
inline constexpr double kLargestSingle = std::numeric_limits<float>::max();
/// "vertex 7 is at 1e+39, ...": what is wrong with a coordinate beyond it.
std::string beyond_single(Eigen::Index vertex, double coordinate);

/// True where single precision would round motion away, or cannot hold a coordinate: `poses` lie
/// far from the origin for a mesh whose longest side is `extent`.
bool needs_double(const PositionsView& poses, double extent);

/// Throws MismatchError that names frame and vertex where single precision would make a coordinate
/// infinite. `poses` are the frames from `first` on.
void check_single_range(const std::filesystem::path& target, int first, const Frames& poses);
/// Whether a format knows nothing else, or was asked for it.
enum class SinglePrecision { only, asked };
/// Throws MismatchError where a `target` in single precision needs_double().
void check_single_precision(const std::filesystem::path& target, const PositionsView& poses,
                            double extent, SinglePrecision why = SinglePrecision::only);

}  // namespace mimetra
