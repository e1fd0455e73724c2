#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/frame_source.h"

/// Names of mesh formats, what their files can store, and the effect of float32 on positions.
namespace mimetra {

enum class MeshFormat { ply, obj, off, stl, om };

/// Name that users write; with a dot in front, it is the extension.
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

/// True for the extension (".obj") of a mesh format, in any case.
bool is_mesh_extension(const std::string& extension);
/// Extensions of all mesh formats, in lower case.
std::vector<std::string> mesh_extensions();
/// Message about a lower-case extension that is_mesh_extension() refuses.
std::string unknown_mesh_extension(const std::string& extension);

/// Parts, besides poses and triangles, that a format can store. Files beside the main one
/// (NAME.rest.ply, NAME.topology.ply) count as part of it.
struct HeldParts {
  enum class Texture { none, vertices, corners };

  /// Faces with more than three corners.
  bool polygons = false;
  /// Texture coordinates: none, one per vertex, or one per corner of a face.
  Texture texture = Texture::none;
  /// Faces without texture coordinates in a mesh where other faces have them.
  bool bare_faces = true;
  /// Groups, and the material of each face.
  bool groups = false;
  /// A rest pose that is not a frame.
  bool rest = true;
  /// The order of vertices; otherwise the format renumbers them.
  bool vertex_order = true;
  /// Times of frames.
  bool times = true;
  /// Unevenly spaced times, in a place that other programs read.
  bool uneven_times = true;
  /// Times in double precision; otherwise they are rounded to single precision.
  bool exact_times = true;
  /// True if positions that single precision would round visibly are stored in double precision or
  /// refused; false if they are rounded.
  bool exact_positions = true;

  bool operator==(const HeldParts&) const = default;
};

/// Summary for lists of formats, such as "polygons, UVs, groups and materials, rest pose".
std::string description(const HeldParts& held);

/// Parts of a sequence that a format cannot store, such as "texture coordinates"; empty if it
/// stores all. Reads a frame only if the sequence has one frame and its rest pose cannot be stored.
std::vector<std::string> parts_left_out(const HeldParts& held, const FrameSource& sequence);

/// Fields read from a mesh file.
struct FieldsRead {
  std::vector<Field> fields = {};
  /// Names of properties that are not fields, for messages.
  std::vector<std::string> left_out = {};
};

/// Largest finite number of single precision.
inline constexpr double kLargestSingle = std::numeric_limits<float>::max();
/// Message about a coordinate beyond that limit: "vertex 7 is at 1e+39, ...".
std::string beyond_single(Eigen::Index vertex, double coordinate);

/// True if single precision would round motion visibly or cannot hold a coordinate. This happens if
/// `poses` lie far from the origin relative to the mesh's longest side, `extent`.
bool needs_double(const PositionsView& poses, double extent);

/// Throws MismatchError with frame and vertex if single precision would make a coordinate infinite.
/// `poses` are the frames from `first` on.
void check_single_range(const std::filesystem::path& target, int first, const Frames& poses);
/// Whether the format has single precision only, or the user asked for it.
enum class SinglePrecision { only, asked };
/// Throws MismatchError if `target` has single precision but needs_double() is true.
void check_single_precision(const std::filesystem::path& target, const PositionsView& poses,
                            double extent, SinglePrecision why = SinglePrecision::only);

}  // namespace mimetra
