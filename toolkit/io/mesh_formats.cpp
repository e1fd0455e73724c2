#include "toolkit/io/mesh_formats.h"

#include <algorithm>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace fs = std::filesystem;

std::string beyond_single(Eigen::Index vertex, double coordinate) {
  return "vertex " + std::to_string(vertex) + " is at " + readable(coordinate) +
         ", and single precision ends at " + readable(kLargestSingle) +
         "; write double precision (.npy without option 'single', or .ply with option 'double'), "
         "or scale it";
}

bool needs_double(const PositionsView& poses, double extent) {
  constexpr double kRounding = 6e-8;     // relative rounding of float32
  constexpr double kMostRounded = 1e-5;  // relative to the longest side; well below what is visible
  const double farthest = poses.cwiseAbs().maxCoeff();
  return farthest > kLargestSingle || kRounding * farthest > kMostRounded * extent;
}

void check_single_range(const fs::path& target, int first, const Frames& poses) {
  Eigen::Index row = 0, column = 0;
  const double farthest = poses.cwiseAbs().maxCoeff(&row, &column);
  if (farthest <= kLargestSingle) return;
  throw MismatchError(target.string() + ": frame " + std::to_string(first + row) + ": " +
                      beyond_single(column / 3, farthest));
}

void check_single_precision(const fs::path& target, const PositionsView& poses, double extent,
                            SinglePrecision why) {
  if (!needs_double(poses, extent)) return;
  const bool is_asked = why == SinglePrecision::asked;
  throw MismatchError(
      target.string() + ": " +
      (is_asked ? "option 'single'"
                : target.extension().string() + " holds single precision only, which") +
      " would round motion that one sees: the mesh lies " +
      readable(poses.cwiseAbs().maxCoeff() / extent, 2) + " times its size from the origin; " +
      (is_asked ? "leave the option out, or move it" : "move it, or write .npy"));
}

bool is_mesh_extension(const std::string& extension) {
  const std::vector<std::string> all = mesh_extensions();
  return std::ranges::find(all, lower_case(extension)) != all.end();
}

std::vector<std::string> mesh_extensions() {
  std::vector<std::string> extensions = choice_names<MeshFormat>();
  for (std::string& extension : extensions) extension.insert(0, ".");
  return extensions;
}

std::string unknown_mesh_extension(const std::string& extension) {
  return (extension.empty() ? "has no extension" : "'" + extension + "' is no mesh format") +
         "; expected " + joined(mesh_extensions(), ", ", " or ");
}

namespace {

bool has_polygons(const Connectivity& connectivity) {
  return connectivity.triangles.rows() > connectivity.polygons.size();
}

bool has_statement(const Connectivity& connectivity, std::string_view keyword) {
  return std::ranges::any_of(connectivity.groups, [keyword](const FaceGroup& group) {
    return group.statement.starts_with(keyword) && group.statement.size() > keyword.size() &&
           group.statement[keyword.size()] == ' ';
  });
}

/// True if numbering positions by their first use in the triangles keeps every vertex's number.
bool is_numbered_by_use(const FrameSource& sequence) {
  int vertices = 0;
  for (const VertexIndex vertex : sequence.triangles().reshaped<Eigen::RowMajor>()) {
    if (vertex > vertices) return false;
    if (vertex == vertices) ++vertices;
  }
  return vertices == sequence.vertices() && Weld::exact(sequence.rest()).count == 0;
}

bool is_its_only_frame(const FrameSource& sequence) {
  return sequence.frames() == 1 &&
         FrameBlock(sequence, 0, 1).frame(0) ==
             PositionsView(sequence.rest().data(), sequence.vertices(), 3);
}

void add_lost_texture(std::vector<std::string>& lost, const HeldParts& held,
                      const Connectivity& connectivity) {
  if (!has_texture(connectivity)) return;
  const auto is_bare = [](int coordinates) { return coordinates < 0; };
  if (held.texture == HeldParts::Texture::none) {
    lost.emplace_back("texture coordinates");
  } else if (held.texture == HeldParts::Texture::vertices && !texture_of_vertices(connectivity)) {
    lost.emplace_back("texture coordinates of a mesh with several at a vertex");
  } else if (!held.bare_faces && std::ranges::any_of(connectivity.texture.corners, is_bare)) {
    lost.emplace_back("faces without texture coordinates");
  }
}

/// Largest change of a time by rounding to single precision, in seconds. Returns 0 if that is at
/// most a thousandth of the shortest step.
double rounding_of(const Eigen::VectorXd& times) {
  constexpr double kLeastShare = 1e-3;
  if (times.size() < 2) return 0;
  const Eigen::Index steps = times.size() - 1;
  const double step = (times.tail(steps) - times.head(steps)).minCoeff();
  const double rounded = (times.cast<float>().cast<double>() - times).cwiseAbs().maxCoeff();
  return rounded > kLeastShare * step ? rounded : 0;
}

/// Largest distance of a time from even spacing, in seconds. Returns 0 if that is at most a
/// hundredth of the mean step.
double unevenness_of(const Eigen::VectorXd& times) {
  constexpr double kLeastShare = 0.01;
  if (times.size() < 3) return 0;
  const double first = times[0], last = times[times.size() - 1];
  const Eigen::VectorXd even = Eigen::VectorXd::LinSpaced(times.size(), first, last);
  const double farthest = (times - even).cwiseAbs().maxCoeff();
  const double step = (last - first) / static_cast<double>(times.size() - 1);
  return farthest > kLeastShare * step ? farthest : 0;
}

}  // namespace

std::string description(const HeldParts& held) {
  std::vector<std::string> words = {held.polygons ? "polygons" : "triangles"};
  if (held.texture == HeldParts::Texture::vertices) words.emplace_back("UVs of vertices");
  if (held.texture == HeldParts::Texture::corners) words.emplace_back("UVs");
  if (held.groups) words.emplace_back("groups and materials");
  if (held.rest) words.emplace_back("rest pose");
  if (!held.vertex_order) words.emplace_back("no order of vertices");
  return joined(words);
}

std::vector<std::string> parts_left_out(const HeldParts& held, const FrameSource& sequence) {
  const Connectivity& connectivity = sequence.connectivity();
  std::vector<std::string> lost;
  if (!held.polygons && has_polygons(connectivity)) {
    lost.emplace_back("faces of more than three corners");
  }
  add_lost_texture(lost, held, connectivity);
  if (!held.groups) {
    if (has_statement(connectivity, "g") || has_statement(connectivity, "o")) {
      lost.emplace_back("groups");
    }
    if (has_statement(connectivity, "usemtl")) lost.emplace_back("materials");
  }
  if (!held.rest && sequence.rest_is_known() && !is_its_only_frame(sequence)) {
    lost.emplace_back("rest pose");
  }
  if (!held.vertex_order && !is_numbered_by_use(sequence)) lost.emplace_back("order of vertices");
  if (const Eigen::VectorXd times = sequence.known_times();
      !held.times && times.size() > 0 && times[0] != 0) {
    lost.push_back("time (its frame is at " + readable(times[0]) + " s)");
  }
  if (const double off = held.uneven_times ? 0 : unevenness_of(sequence.known_times()); off > 0) {
    lost.push_back("uneven times (programs that do not read the .times.csv beside it show frames " +
                   readable(off, 2) + " s off)");
  }
  if (const double rounded = held.exact_times ? 0 : rounding_of(sequence.known_times());
      rounded > 0) {
    lost.push_back("exact times (rounded by up to " + readable(rounded) + " s)");
  }
  const Positions& rest = sequence.rest();
  const double size = extent(rest);
  if (!held.exact_positions && needs_double({rest.data(), rest.rows(), 3}, size)) {
    const double farthest = rest.cwiseAbs().maxCoeff();
    lost.push_back("exact positions (rounded by up to " +
                   readable(std::numeric_limits<float>::epsilon() / 2 * farthest, 2) +
                   ", as the mesh lies " + readable(farthest / size, 2) +
                   " times its size from the origin)");
  }
  return lost;
}

}  // namespace mimetra
