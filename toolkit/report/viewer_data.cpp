#include "toolkit/report/viewer_data.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <vtkNew.h>
#include <vtkZLibDataCompressor.h>

#include "toolkit/drawing/sheet_layout.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/operations/colors.h"
#include "toolkit/operations/json.h"
#include "toolkit/report/base64.h"

namespace mimetra {

namespace {

/// Between frames the viewer interpolates: more of them are not seen.
constexpr double kMostFramesPerSecond = 30;
constexpr int kEvenColors = 64;

/// zlib's format as base64.
std::string compressed(const std::vector<unsigned char>& bytes) {
  vtkNew<vtkZLibDataCompressor> compressor;
  std::vector<unsigned char> packed(compressor->GetMaximumCompressionSpace(bytes.size()));
  packed.resize(compressor->Compress(bytes.data(), bytes.size(), packed.data(), packed.size()));
  return base64({reinterpret_cast<const char*>(packed.data()), packed.size()});
}

/// The difference of each pose from the one before, all low bytes of a pose before its high ones:
/// what hardly moves becomes long runs of zeros.
std::string packed_poses(const QuantizedPoses& quantized) {
  const auto& poses = quantized.poses;
  const auto width = static_cast<std::size_t>(poses.cols());
  std::vector<unsigned char> bytes(2 * width * static_cast<std::size_t>(poses.rows()));
  unsigned char* out = bytes.data();
  for (Eigen::Index f = 0; f < poses.rows(); ++f, out += 2 * width) {
    for (std::size_t i = 0; i < width; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const int before = f > 0 ? poses(f - 1, column) : 0;
      const auto difference = static_cast<unsigned>(poses(f, column) - before);
      out[i] = static_cast<unsigned char>(difference & 0xffU);
      out[width + i] = static_cast<unsigned char>((difference >> 8U) & 0xffU);
    }
  }
  return compressed(bytes);
}

/// 32-bit differences from the number before, low bytes first.
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

/// The colour that the still pictures give each region.
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

/// The number of each mesh's surface: one for all that have the same triangles and regions.
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

/// Their faces, the lowest vertex at each vertex's place, and regions.
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

/// From where the scene is seen first, the half width and height that show all of it, and how far
/// from its middle the farthest vertex lies.
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

/// All of a scene but its frames.
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

/// JSON that may stand in a script element.
std::string script_text(const Json& json) {
  std::string text = json_text(json);
  for (std::size_t i = 0; (i = text.find('<', i)) != std::string::npos;) {
    text.replace(i, 1, "\\u003c");
  }
  return text;
}

std::string with_frames(Json json, const ViewerScene& scene, const std::vector<int>& frames) {
  Json times = Json::array();
  for (const int frame : frames) times.push_back(scene.meshes.front().sequence.times()[frame]);
  json["times"] = times;
  json["meshes"] = Json::array();
  const std::vector<std::size_t> surface = surface_of_each(scene.meshes);
  const int count = static_cast<int>(scene.meshes.size());
  std::vector<Json> meshes(scene.meshes.size());
  parallel_for(count, scene.threads, [&](int i) {
    const auto place = static_cast<std::size_t>(i);
    const ViewerMesh& mesh = scene.meshes[place];
    const QuantizedPoses poses = quantized(mesh.sequence, frames);
    meshes[place] = {{"role", mesh.role},
                     {"name", mesh.name},
                     {"surface", surface[place]},
                     {"step", poses.step},
                     {"poses", packed_poses(poses)}};
  });
  for (Json& mesh : meshes) json["meshes"].push_back(std::move(mesh));
  return script_text(json);
}

/// Frames that may be seen, and that may fit: zlib makes poses hardly ever this much smaller.
int most_frames(const ViewerScene& scene, std::size_t bytes) {
  constexpr double kBestCompression = 40;
  const MeshSequence& first = scene.meshes.front().sequence;
  const double seconds = first.times()[first.frames() - 1] - first.times()[0];
  double pose = 0;
  for (const ViewerMesh& mesh : scene.meshes) pose += 6.0 * mesh.sequence.vertices();
  const double most = std::min({double(first.frames()), seconds * kMostFramesPerSecond + 1.5,
                                kBestCompression * static_cast<double>(bytes) / pose});
  return std::max(2, static_cast<int>(most));
}

}  // namespace

QuantizedPoses quantized(const MeshSequence& sequence, const std::vector<int>& frames) {
  QuantizedPoses result;
  const Positions& rest = sequence.rest();
  result.center = (rest.colwise().minCoeff() + rest.colwise().maxCoeff()) / 2;
  double reach = (rest.rowwise() - result.center).cwiseAbs().maxCoeff();
  for (const int frame : frames) {
    reach =
        std::max(reach, (sequence.frame(frame).rowwise() - result.center).cwiseAbs().maxCoeff());
  }
  result.step = reach > 0 ? reach / kMostSteps : 1;
  result.poses.resize(static_cast<Eigen::Index>(frames.size()) + 1, rest.size());
  const auto add = [&](Eigen::Index row, const Positions& pose) {
    const Positions steps = (pose.rowwise() - result.center) / result.step;
    for (Eigen::Index i = 0; i < steps.size(); ++i) {
      result.poses(row, i) = static_cast<std::int16_t>(std::lround(steps.data()[i]));
    }
  };
  add(0, rest);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    add(static_cast<Eigen::Index>(i) + 1, sequence.frame(frames[i]));
  }
  return result;
}

std::vector<int> thinned(int frames, int count) {
  const int kept = std::min(frames, count);
  std::vector<int> result;
  for (int i = 0; i < kept; ++i) {
    const auto place = std::int64_t{i} * (frames - 1);
    result.push_back(kept == 1 ? 0 : static_cast<int>(place / (kept - 1)));
  }
  return result;
}

PackedScene packed(const ViewerScene& scene, std::size_t bytes) {
  constexpr double kSafety = 0.97;
  const Json still = still_part(scene);
  const auto always = static_cast<double>(script_text(still).size());
  const int frames = scene.meshes.front().sequence.frames();
  for (int count = std::min(frames, most_frames(scene, bytes));;) {
    std::string json = with_frames(still, scene, thinned(frames, count));
    if (json.size() <= bytes) return {std::move(json), count};
    if (count <= 2) return {};
    const double share =
        (static_cast<double>(bytes) - always) / (static_cast<double>(json.size()) - always);
    count = std::clamp(static_cast<int>(kSafety * share * count), 2, count - 1);
  }
}

}  // namespace mimetra
