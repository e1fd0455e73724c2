#include "toolkit/report/viewer_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>

#include <vtkBase64Utilities.h>
#include <vtkNew.h>
#include <vtkZLibDataCompressor.h>
#include <nlohmann/json.hpp>

#include "toolkit/drawing/sheet_layout.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/operations/colors.h"
#include "toolkit/splocs/time_basis.h"

namespace mimetra {

std::string base64(std::string_view bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3), '=');
  text.resize(vtkBase64Utilities::Encode(reinterpret_cast<const unsigned char*>(bytes.data()),
                                         bytes.size(),
                                         reinterpret_cast<unsigned char*>(text.data())));
  return text;
}

namespace {

/// Grid of coded poses: steps from a centre.
struct Grid {
  Eigen::RowVector3d center;
  double step = 1;
};

Grid grid_of(const MeshSequence& sequence, const std::vector<int>& frames) {
  const Positions& rest = sequence.rest();
  Grid grid;
  grid.center = (rest.colwise().minCoeff() + rest.colwise().maxCoeff()) / 2;
  double reach = (rest.rowwise() - grid.center).cwiseAbs().maxCoeff();
  for (const int frame : frames) {
    reach = std::max(reach, (sequence.frame(frame).rowwise() - grid.center).cwiseAbs().maxCoeff());
  }
  if (reach > 0) grid.step = reach / kMostSteps;
  return grid;
}

/// Pose in steps (1 x 3N).
Eigen::RowVectorXd in_steps(const PositionsView& pose, const Grid& grid) {
  const Positions steps = (pose.rowwise() - grid.center) / grid.step;
  return steps.reshaped<Eigen::RowMajor>().transpose();
}

/// Rounds numbers. \pre `numbers` are at most 32767
StepMatrix rounded(const Eigen::Ref<const Frames>& numbers) {
  return numbers.unaryExpr(
      [](double number) { return static_cast<std::int16_t>(std::lround(number)); });
}

/// Displacements of the frames from the rest pose, in steps.
class Displacements : public BlockSource<double> {
 public:
  Displacements(const MeshSequence& sequence, const std::vector<int>& frames, double step,
                const VertexPart& part)
      : BlockSource(std::ssize(frames), part), sequence_(sequence), frames_(frames), step_(step) {}

  std::shared_ptr<const Block> block(int b) const override {
    auto block = std::make_shared<Block>(rows(), 3 * size(b));
    const auto of_block = [&](const auto& pose) { return pose.middleRows(first(b), size(b)); };
    for (Eigen::Index row = 0; row < rows(); ++row) {
      const PositionsView pose = sequence_.frame(frames_[static_cast<std::size_t>(row)]);
      by_vertex(*block, row) = (of_block(pose) - of_block(sequence_.rest())) / step_;
    }
    return block;
  }

  double squared_norm() const {
    double sum = 0;
    for (int b = 0; b < count(); ++b) sum += block(b)->squaredNorm();
    return sum;
  }

 private:
  const MeshSequence& sequence_;
  const std::vector<int>& frames_;
  double step_;
};

/// Corrections of coordinates that the mixtures miss by more than a step.
std::vector<MixedPoses::Correction> corrections_of(const MixedPoses& mixed,
                                                   const MeshSequence& sequence,
                                                   const std::vector<int>& frames) {
  const Grid grid{mixed.center, mixed.step};
  const Eigen::RowVectorXd rest = mixed.rest.cast<double>() / MixedPoses::kStepsOfRest;
  const Frames basis = mixed.basis.cast<double>() * (mixed.basis_step / MixedPoses::kWeightOfOne);
  std::vector<MixedPoses::Correction> corrections;
  for (Eigen::Index f = 0; f < mixed.weights.rows(); ++f) {
    const Eigen::RowVectorXd shown = rest + mixed.weights.row(f).cast<double>() * basis;
    const Eigen::RowVectorXd missed =
        in_steps(sequence.frame(frames[static_cast<std::size_t>(f)]), grid) - shown;
    for (Eigen::Index i = 0; i < missed.size(); ++i) {
      if (std::abs(missed[i]) <= 1) continue;
      corrections.push_back(
          {static_cast<int>(f), static_cast<int>(i), static_cast<int>(std::lround(missed[i]))});
    }
  }
  return corrections;
}

}  // namespace

QuantizedPoses quantized(const MeshSequence& sequence, const std::vector<int>& frames) {
  const Grid grid = grid_of(sequence, frames);
  QuantizedPoses result{grid.center, grid.step, {}};
  result.poses.resize(std::ssize(frames) + 1, sequence.rest().size());
  const PositionsView rest(sequence.rest().data(), sequence.vertices(), 3);
  result.poses.row(0) = rounded(in_steps(rest, grid));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    result.poses.row(static_cast<Eigen::Index>(i) + 1) =
        rounded(in_steps(sequence.frame(frames[i]), grid));
  }
  return result;
}

std::optional<MixedPoses> mixed(const MeshSequence& sequence, const std::vector<int>& frames,
                                Eigen::Index most, const Context& context) {
  fix_product_blocking();
  constexpr double kOffByBasis = 1. / 4, kOffByRounding = 1. / 8;  // root mean squares, in steps
  const Grid grid = grid_of(sequence, frames);
  const Displacements X(sequence, frames, grid.step, VertexPart(sequence.vertices()));
  const double norm2 = X.squared_norm();
  const double numbers = static_cast<double>(frames.size()) * 3 * sequence.vertices();
  const double tolerance = norm2 > 0 ? kOffByBasis * std::sqrt(numbers / norm2) : 1;
  if (tolerance < kLeastBasisTolerance) return std::nullopt;
  // A sketch needs more poses than the basis that it finds.
  const Eigen::Index sketched = std::max<Eigen::Index>(64, 2 * most);
  const auto found =
      time_basis(X, norm2, std::min(1.0, tolerance), sketched, context.without_ranks());
  if (!found || found->B.rows() > most) return std::nullopt;

  // Scale each pose so that its largest weight is 1.
  const Eigen::RowVectorXd largest =
      found->Q.cwiseAbs().colwise().maxCoeff().cwiseMax(std::numeric_limits<double>::min());
  const Frames weights = found->Q.array().rowwise() / largest.array();
  const Frames basis = largest.transpose().asDiagonal() * found->B.frames();
  MixedPoses result{grid.center, grid.step, {}, {}, {}, {}, {}};
  const PositionsView rest(sequence.rest().data(), sequence.vertices(), 3);
  result.rest = rounded(MixedPoses::kStepsOfRest * in_steps(rest, grid));
  // Rounding has an error of 1 / sqrt(12) of a step in each of the poses.
  result.basis_step = std::max(kOffByRounding * std::sqrt(12 / static_cast<double>(basis.rows())),
                               basis.cwiseAbs().maxCoeff() / MixedPoses::kWeightOfOne);
  result.basis = rounded(basis / result.basis_step);
  result.weights = rounded(MixedPoses::kWeightOfOne * weights);
  result.corrections = corrections_of(result, sequence, frames);
  return result;
}

namespace {

/// The viewer interpolates between frames, so more frames would not be visible.
constexpr double kMostFramesPerSecond = 30;
constexpr int kEvenColors = 64;

/// Compresses bytes in zlib's format, as base64.
std::string compressed(const std::vector<unsigned char>& bytes) {
  vtkNew<vtkZLibDataCompressor> compressor;
  std::vector<unsigned char> packed(compressor->GetMaximumCompressionSpace(bytes.size()));
  packed.resize(compressor->Compress(bytes.data(), bytes.size(), packed.data(), packed.size()));
  return base64({reinterpret_cast<const char*>(packed.data()), packed.size()});
}

enum class Rows { as_they_are, as_differences };

/// Packs the low bytes of each row before the high bytes. Differences from the row before turn
/// nearly still coordinates into long runs of zeros.
std::string packed_rows(const StepMatrix& rows, Rows kind) {
  const auto width = static_cast<std::size_t>(rows.cols());
  std::vector<unsigned char> bytes(2 * width * static_cast<std::size_t>(rows.rows()));
  unsigned char* out = bytes.data();
  for (Eigen::Index f = 0; f < rows.rows(); ++f, out += 2 * width) {
    const bool differs = kind == Rows::as_differences && f > 0;
    for (std::size_t i = 0; i < width; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const int before = differs ? rows(f - 1, column) : 0;
      const auto number = static_cast<unsigned>(rows(f, column) - before);
      out[i] = static_cast<unsigned char>(number & 0xffU);
      out[width + i] = static_cast<unsigned char>((number >> 8U) & 0xffU);
    }
  }
  return compressed(bytes);
}

/// Packs 32-bit differences from the number before, low bytes first.
std::string packed_indices(const std::vector<int>& indices) {
  std::vector<unsigned char> bytes;
  bytes.reserve(4 * indices.size());
  int before = 0;
  for (const int index : indices) {
    const auto difference = static_cast<unsigned>(index - before);
    for (unsigned shift = 0; shift < 32; shift += 8) {
      bytes.push_back(static_cast<unsigned char>((difference >> shift) & 0xffU));
    }
    before = index;
  }
  return compressed(bytes);
}

std::vector<int> flat(const Triangles& triangles) {
  std::vector<int> indices;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (const int vertex : triangles.row(t)) indices.push_back(vertex);
  }
  return indices;
}

Json json_of(const Color& color) {
  return {color.red, color.green, color.blue};
}

Json json_of(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

/// Colour of each region, as in the still pictures.
Json region_colors(const ViewerMesh& mesh) {
  const int last = mesh.regions.empty() ? -1 : *std::ranges::max_element(mesh.regions);
  Json colors = Json::array();
  for (const Color& color : colors_by_category(mesh.regions, mesh.sequence.triangles(),
                                               static_cast<std::size_t>(last + 1))) {
    colors.push_back(json_of(color));
  }
  return colors;
}

bool have_one_surface(const ViewerMesh& a, const ViewerMesh& b) {
  const Triangles &of_a = a.sequence.triangles(), &of_b = b.sequence.triangles();
  return of_a.rows() == of_b.rows() && of_a == of_b && a.regions == b.regions;
}

/// Index of each mesh's surface. Meshes with the same triangles and regions share one.
std::vector<std::size_t> surface_of_each(const std::vector<ViewerMesh>& meshes) {
  std::vector<std::size_t> first_of, surface;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto same = std::ranges::find_if(
        first_of, [&](std::size_t first) { return have_one_surface(meshes[first], meshes[i]); });
    surface.push_back(static_cast<std::size_t>(same - first_of.begin()));
    if (same == first_of.end()) first_of.push_back(i);
  }
  return surface;
}

/// Faces, welded vertices and regions of each surface.
Json json_of_surfaces(const std::vector<ViewerMesh>& meshes) {
  Json surfaces = Json::array();
  const std::vector<std::size_t> surface = surface_of_each(meshes);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (surface[i] < surfaces.size()) continue;
    const MeshSequence& sequence = meshes[i].sequence;
    surfaces.push_back({{"vertices", sequence.vertices()},
                        {"triangles", packed_indices(flat(sequence.triangles()))},
                        {"places", packed_indices(Weld::exact(sequence.rest()).representative)},
                        {"regions", packed_indices(meshes[i].regions)}});
  }
  return surfaces;
}

double largest_displacement(const ViewerScene& scene) {
  double largest = 0;
  for (const ViewerMesh& mesh : scene.meshes) {
    for (int f = 0; f < mesh.sequence.frames(); ++f) {
      const Positions moved = mesh.sequence.frame(f) - mesh.sequence.rest();
      largest = std::max(largest, moved.rowwise().norm().maxCoeff());
    }
  }
  return largest;
}

/// Initial view of the scene: direction, half width and half height that show everything, and the
/// distance of the farthest vertex from its mesh's middle.
Json view_of_scene(const ViewerScene& scene) {
  constexpr double kSpaceAround = 1.05;
  const View view = view_of(scene.viewpoint);
  Eigen::Vector2d half = Eigen::Vector2d::Zero();
  double reach = 0;
  for (const ViewerMesh& mesh : scene.meshes) {
    const Positions& rest = mesh.sequence.rest();
    const Eigen::RowVector3d center = (rest.colwise().minCoeff() + rest.colwise().maxCoeff()) / 2;
    for (int f = 0; f < mesh.sequence.frames(); ++f) {
      const Positions centered = mesh.sequence.frame(f).rowwise() - center;
      half[0] = std::max(half[0], (centered * view.right).cwiseAbs().maxCoeff());
      half[1] = std::max(half[1], (centered * view.up).cwiseAbs().maxCoeff());
      reach = std::max(reach, centered.rowwise().norm().maxCoeff());
    }
  }
  half *= kSpaceAround;
  return {{"towardsEye", json_of(view.towards_eye)},
          {"up", json_of(view.up)},
          {"halfWidth", half[0]},
          {"halfHeight", half[1]},
          {"reach", reach}};
}

/// The scene without its frames.
Json still_part(const ViewerScene& scene) {
  Json even = Json::array();
  for (int i = 0; i < kEvenColors; ++i) {
    even.push_back(json_of(even_color(double(i) / (kEvenColors - 1))));
  }
  return {{"surfaces", json_of_surfaces(scene.meshes)},
          {"regionColors", region_colors(scene.meshes.front())},
          {"evenColors", even},
          {"clay", json_of(kClay)},
          {"largest", largest_displacement(scene)},
          {"view", view_of_scene(scene)}};
}

/// JSON text that is safe inside a script element.
std::string script_text(const Json& json) {
  std::string text = json_text(json);
  for (std::size_t i = 0; (i = text.find('<', i)) != std::string::npos;) {
    text.replace(i, 1, "\\u003c");
  }
  return text;
}

/// Packs a mesh's frames in one of two codings.
using PackPoses = std::function<Json(const MeshSequence& sequence)>;

Json json_of_poses(const QuantizedPoses& poses) {
  return {{"step", poses.step}, {"poses", packed_rows(poses.poses, Rows::as_differences)}};
}

Json json_of_poses(const MixedPoses& mixed) {
  std::vector<int> places, steps;
  for (const MixedPoses::Correction& correction : mixed.corrections) {
    places.push_back(correction.frame * static_cast<int>(mixed.rest.cols()) +
                     correction.coordinate);
    steps.push_back(correction.steps);
  }
  return {{"step", mixed.step},
          {"rest", packed_rows(mixed.rest, Rows::as_they_are)},
          {"stepsOfRest", MixedPoses::kStepsOfRest},
          {"basis", packed_rows(mixed.basis, Rows::as_they_are)},
          {"basisSize", mixed.basis.rows()},
          {"basisStep", mixed.basis_step / MixedPoses::kWeightOfOne},
          {"weights", packed_rows(mixed.weights, Rows::as_differences)},
          {"correctedPlaces", packed_indices(places)},
          {"corrections", packed_indices(steps)}};
}

/// The whole scene; empty if the poses of any mesh are null.
std::string with_frames(Json json, const ViewerScene& scene, const std::vector<int>& frames,
                        const PackPoses& pack, const Context& context) {
  Json times = Json::array();
  for (const int frame : frames) times.push_back(scene.meshes.front().sequence.times()[frame]);
  json["times"] = times;
  json["meshes"] = Json::array();
  const std::vector<std::size_t> surface = surface_of_each(scene.meshes);
  const int count = static_cast<int>(scene.meshes.size());
  std::vector<Json> meshes(scene.meshes.size());
  const auto pack_one = [&](int i) {
    const auto place = static_cast<std::size_t>(i);
    const ViewerMesh& mesh = scene.meshes[place];
    Json packed = pack(mesh.sequence);
    if (packed.is_null()) return;
    packed.update({{"role", mesh.role}, {"name", mesh.name}, {"surface", surface[place]}});
    meshes[place] = std::move(packed);
  };
  parallel_for(count, pack_one, context);
  for (Json& mesh : meshes) {
    if (mesh.is_null()) return "";
    json["meshes"].push_back(std::move(mesh));
  }
  return script_text(json);
}

/// Number of whole frames that can be seen.
int seen_frames(const ViewerScene& scene) {
  const MeshSequence& first = scene.meshes.front().sequence;
  const double seconds = first.times()[first.frames() - 1] - first.times()[0];
  const double most = std::min(double(first.frames()), seconds * kMostFramesPerSecond + 1.5);
  return std::max(std::min(2, first.frames()), static_cast<int>(most));
}

/// Bytes of the coordinates of all meshes in one pose.
double pose_bytes(const ViewerScene& scene) {
  double bytes = 0;
  for (const ViewerMesh& mesh : scene.meshes) bytes += 6.0 * mesh.sequence.vertices();
  return bytes;
}

/// All frames as mixtures of a few poses; empty if no such mixtures exist or they need more than
/// `bytes`.
std::string with_mixed_frames(const Json& still, const ViewerScene& scene, std::size_t bytes,
                              const Context& context) {
  // zlib and base64 leave at least about half of poses without a pattern.
  constexpr double kLeastShare = 0.5;
  const auto most =
      static_cast<Eigen::Index>(static_cast<double>(bytes) / (kLeastShare * pose_bytes(scene)));
  std::vector<int> frames(static_cast<std::size_t>(scene.meshes.front().sequence.frames()));
  std::iota(frames.begin(), frames.end(), 0);
  const Context each = scene.meshes.size() == 1 ? context : context.serial();
  const auto pack = [&](const MeshSequence& sequence) -> Json {
    if (std::ssize(frames) * std::int64_t{3} * sequence.vertices() > INT32_MAX) return {};
    const auto poses = mixed(sequence, frames, most, each);
    return poses ? json_of_poses(*poses) : Json();
  };
  return with_frames(still, scene, frames, pack, context);
}

}  // namespace

std::vector<int> thinned(int frames, int count) {
  const int kept = std::min(frames, count);
  std::vector<int> result;
  for (int i = 0; i < kept; ++i) {
    const auto place = std::int64_t{i} * (frames - 1);
    result.push_back(kept == 1 ? 0 : static_cast<int>(place / (kept - 1)));
  }
  return result;
}

PackedScene packed(const ViewerScene& scene, std::size_t bytes, const Context& context) {
  // zlib hardly ever compresses poses more than this.
  constexpr double kBestCompression = 40;
  constexpr double kSafety = 0.97;
  const Json still = still_part(scene);
  const int frames = scene.meshes.front().sequence.frames();
  // The number of attempts is unknown, so they report no progress.
  const Context attempt = context.part(0, 0);
  std::string mixed = with_mixed_frames(still, scene, bytes, attempt);
  if (!mixed.empty() && mixed.size() <= bytes) return {std::move(mixed), frames};

  const auto always = static_cast<double>(script_text(still).size());
  const double most = kBestCompression * static_cast<double>(bytes) / pose_bytes(scene);
  int count = std::min(seen_frames(scene), std::max(2, static_cast<int>(most)));
  while (true) {
    const std::vector<int> kept = thinned(frames, count);
    const auto pack = [&kept](const MeshSequence& sequence) {
      return json_of_poses(quantized(sequence, kept));
    };
    std::string json = with_frames(still, scene, kept, pack, attempt);
    if (json.size() <= bytes) return {std::move(json), count};
    if (count <= 2) return {};
    const double share =
        (static_cast<double>(bytes) - always) / (static_cast<double>(json.size()) - always);
    count = std::clamp(static_cast<int>(kSafety * share * count), 2, count - 1);
  }
}

}  // namespace mimetra
