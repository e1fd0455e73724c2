#include "toolkit/correspondence/face_openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/surface.h"

namespace mimetra {
namespace {

/// Reach of an edge from its landmarks, as a share of the opening's width. Lips are thick, and the
/// bottom of an eye socket is farther away.
constexpr double kEdgeReach = 0.4;
/// If edges meet behind the opening, as in the bag of a mouth, each ends at this share of the path
/// to the other.
constexpr double kShareOfWay = 0.4;
/// A path between the edges that is shorter than this multiple of the straight line crosses uncut
/// skin.
constexpr double kDetour = 1.6;
/// Half width of the band around the opening's middle, as a share of the width. The edges meet at
/// the corners.
constexpr double kBand = 0.25;

struct Scheme {
  std::string_view name;
  std::array<int, 2> corners;
  std::vector<int> upper, lower;
};

const std::array<Scheme, 3>& schemes() {
  static const std::array<Scheme, 3> all = {{{"right eye", {36, 39}, {37, 38}, {41, 40}},
                                             {"left eye", {42, 45}, {43, 44}, {47, 46}},
                                             {"mouth", {48, 54}, {50, 51, 52}, {58, 57, 56}}}};
  return all;
}

/// Welded surface of the face.
struct Skin {
  explicit Skin(const TriMesh& rest)
      : positions(rest.positions),
        weld(Weld::exact(rest.positions)),
        surface(rest.connectivity.triangles, weld) {}

  double distance(VertexIndex a, VertexIndex b) const {
    return (positions.row(a) - positions.row(b)).norm();
  }

  const Positions& positions;
  Weld weld;
  Surface surface;
};

/// Vertices within reach of two groups of vertices, along edges.
struct Reached {
  std::map<VertexIndex, double> distance;  ///< from the nearer group
  std::map<VertexIndex, int> group;        ///< number of the nearer group, 0 or 1
};

Reached reached_from(const Skin& skin, const std::array<std::vector<VertexIndex>, 2>& groups,
                     double reach) {
  Reached result;
  for (int g = 0; g < 2; ++g) {
    for (const auto& [vertex, distance] :
         within_reach(skin.surface, skin.positions, reach, groups[g])) {
      const auto known = result.distance.find(vertex);
      if (known != result.distance.end() && known->second <= distance) continue;
      result.distance[vertex] = distance;
      result.group[vertex] = g;
    }
  }
  return result;
}

struct Edges {
  Edges(const Skin& skin, const Scheme& scheme, const std::map<int, VertexIndex>& vertex_of)
      : from(skin.positions.row(vertex_of.at(scheme.corners[0]))),
        to(skin.positions.row(vertex_of.at(scheme.corners[1]))),
        width((to - from).norm()) {
    for (std::size_t i = 0; i < scheme.upper.size(); ++i) {
      const VertexIndex upper = vertex_of.at(scheme.upper[i]),
                        lower = vertex_of.at(scheme.lower[i]);
      landmarks[0].push_back(skin.weld.representative[upper]);
      landmarks[1].push_back(skin.weld.representative[lower]);
      apart += (skin.positions.row(upper) - skin.positions.row(lower)).norm() /
               static_cast<double>(scheme.upper.size());
    }
  }

  bool is_in_band(const Eigen::RowVector3d& place) const {
    return std::abs((place - (from + to) / 2).dot(to - from)) <= kBand * width * width;
  }

  Eigen::RowVector3d from, to;
  double width;
  std::array<std::vector<VertexIndex>, 2> landmarks;  ///< upper and lower
  double apart = 0;  ///< mean distance between the landmarks of a pair
};

/// Shortest path from one edge's landmarks to the other's that crosses in the band; infinite if
/// there is none.
double way_between(const Skin& skin, const Edges& edges, const Reached& reached) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [vertex, group] : reached.group) {
    if (group != 0 || !edges.is_in_band(skin.positions.row(vertex))) continue;
    for (const VertexIndex to : skin.surface.neighbors(vertex)) {
      const auto other = reached.group.find(to);
      if (other == reached.group.end() || other->second != 1) continue;
      shortest = std::min(shortest, reached.distance.at(vertex) + skin.distance(vertex, to) +
                                        reached.distance.at(to));
    }
  }
  return shortest;
}

/// Opening of a scheme; its edges are empty if uncut skin connects them.
FaceOpening opening_between(const Skin& skin, const Scheme& scheme,
                            const std::map<int, VertexIndex>& vertex_of) {
  const Edges edges(skin, scheme, vertex_of);
  FaceOpening opening{scheme.name, {}, {}, edges.width};
  const Reached reached = reached_from(skin, edges.landmarks, edges.width);
  const double way = way_between(skin, edges, reached);
  if (way < kDetour * edges.apart) return opening;
  const double reach = std::min(kEdgeReach * edges.width, kShareOfWay * way);
  for (const auto& [vertex, group] : reached.group) {
    if (reached.distance.at(vertex) > reach || !edges.is_in_band(skin.positions.row(vertex))) {
      continue;
    }
    (group == 0 ? opening.upper : opening.lower).push_back(vertex);
  }
  return opening;
}

double shortest_distance(const Eigen::Ref<const Positions>& pose, const FaceOpening& opening) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const VertexIndex u : opening.upper) {
    for (const VertexIndex v : opening.lower) {
      shortest = std::min(shortest, (pose.row(u) - pose.row(v)).squaredNorm());
    }
  }
  return std::sqrt(shortest);
}

}  // namespace

std::vector<FaceOpening> face_openings(const TriMesh& rest, const LandmarkVertices& landmarks) {
  std::map<int, VertexIndex> vertex_of;
  for (const auto& [landmark, vertex] : landmarks) {
    if (vertex < 0 || vertex >= rest.connectivity.vertices) {
      throw std::invalid_argument("landmark " + std::to_string(landmark) + ": vertex " +
                                  std::to_string(vertex) + ", expected 0 to " +
                                  std::to_string(rest.connectivity.vertices - 1));
    }
    vertex_of[landmark] = vertex;
  }
  const Skin skin(rest);
  std::vector<FaceOpening> result;
  for (const Scheme& scheme : schemes()) {
    std::vector<int> needed = {scheme.corners[0], scheme.corners[1]};
    needed.insert(needed.end(), scheme.upper.begin(), scheme.upper.end());
    needed.insert(needed.end(), scheme.lower.begin(), scheme.lower.end());
    if (!std::ranges::all_of(needed, [&](int landmark) { return vertex_of.contains(landmark); })) {
      continue;
    }
    FaceOpening opening = opening_between(skin, scheme, vertex_of);
    if (!opening.upper.empty() && !opening.lower.empty()) result.push_back(std::move(opening));
  }
  return result;
}

Eigen::MatrixXd openness(const FrameSource& sequence, const std::vector<FaceOpening>& openings,
                         const Context& context) {
  Eigen::MatrixXd result(sequence.frames(), static_cast<Eigen::Index>(openings.size()));
  const auto measure = [&](int first, const Frames& poses) {
    for (Eigen::Index f = 0; f < poses.rows(); ++f) {
      const Eigen::Map<const Positions> pose(poses.row(f).data(), sequence.vertices(), 3);
      for (Eigen::Index o = 0; o < result.cols(); ++o) {
        result(first + f, o) = shortest_distance(pose, openings[o]) / openings[o].width;
      }
    }
  };
  for_each_block(sequence, measure, context);
  return result;
}

}  // namespace mimetra
