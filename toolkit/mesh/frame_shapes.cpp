#include "toolkit/mesh/frame_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/LU>

#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

// Least determinant of a map between centred poses, each scaled by its spread. For a rotated head
// or mask it exceeds 0.01. Below this limit, one pose is nearly flat or they have nothing in
// common.
constexpr double kFlat = 1e-3;

Positions centred(const Eigen::Ref<const Positions>& positions) {
  return positions.rowwise() - positions.colwise().mean();
}

/// Length of the longest edge at each vertex (N).
Eigen::VectorXd longest_edges(const Positions& positions, const Triangles& triangles) {
  Eigen::VectorXd longest = Eigen::VectorXd::Zero(positions.rows());
  for (const auto& corners : triangles.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = corners[c], b = corners[(c + 1) % 3];
      const double length = (positions.row(a) - positions.row(b)).norm();
      longest[a] = std::max(longest[a], length);
      longest[b] = std::max(longest[b], length);
    }
  }
  return longest;
}

/// Shape of the rest pose, to which frames are compared.
struct RestShape {
  explicit RestShape(const FrameSource& sequence)
      : surface(surface_vertices(sequence.rest(), sequence.triangles())),
        triangles(with_area(sequence.rest(), sequence.triangles())),
        centred_rest(centred(sequence.rest()(surface, Eigen::all))),
        of_spread(spread(centred_rest)),
        strays(sequence.rest(), triangles) {}

  static PositionsView view_of(const Positions& positions) {
    return {positions.data(), positions.rows(), 3};
  }

  std::vector<VertexIndex> surface;
  Triangles triangles;
  Positions centred_rest;  // surface vertices only
  double of_spread;
  StrayVertices strays;
};

FrameShape shape_of(const PositionsView& pose, const RestShape& rest) {
  FrameShape shape;
  const Positions surface = pose(rest.surface, Eigen::all);
  const Positions moved = centred(surface);
  const auto count = static_cast<double>(moved.rows());
  shape.spread = spread(moved);
  shape.center = surface.colwise().mean().transpose();
  if (shape.spread > 0 && rest.of_spread > 0) {
    const Eigen::Matrix3d mixed =
        moved.transpose() * rest.centred_rest / (count * shape.spread * rest.of_spread);
    shape.is_mirrored = mixed.determinant() < -kFlat;
  }
  double longest2 = 0;
  for (const auto& corners : rest.triangles.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = corners[c], b = corners[(c + 1) % 3];
      const double length2 = (pose.row(a) - pose.row(b)).squaredNorm();
      if (length2 <= longest2) continue;
      longest2 = length2;
      shape.ends = {a, b};
    }
  }
  shape.longest_edge = std::sqrt(longest2);
  if (rest.triangles.rows() > 0) {
    shape.stray = rest.strays.distances(pose).maxCoeff(&shape.stray_vertex);
  }
  return shape;
}

/// Number of values in a shape that ranks send to each other.
constexpr Eigen::Index kShapeNumbers = 11;
using ShapeNumbers = Eigen::Matrix<double, 1, kShapeNumbers>;

ShapeNumbers numbers_of(const FrameShape& shape) {
  ShapeNumbers numbers;
  numbers << shape.spread, shape.center.transpose(), shape.is_mirrored, shape.longest_edge,
      shape.ends.first, shape.ends.second, shape.stray, shape.stray_vertex, shape.from_first;
  return numbers;
}

FrameShape shape_from(const ShapeNumbers& numbers) {
  const auto vertex = [&numbers](int place) { return static_cast<VertexIndex>(numbers[place]); };
  FrameShape shape;
  shape.spread = numbers[0];
  shape.center = numbers.segment<3>(1).transpose();
  shape.is_mirrored = numbers[4] != 0;
  shape.longest_edge = numbers[5];
  shape.ends = {vertex(6), vertex(7)};
  shape.stray = numbers[8];
  shape.stray_vertex = vertex(9);
  shape.from_first = numbers[10];
  return shape;
}

}  // namespace

double spread(const Eigen::Ref<const Positions>& positions) {
  if (positions.rows() == 0) return 0;
  return std::sqrt(centred(positions).squaredNorm() / static_cast<double>(positions.rows()));
}

double spread(const Positions& positions, const Triangles& triangles) {
  return spread(positions(surface_vertices(positions, triangles), Eigen::all));
}

bool is_other_size(double length, double usual) {
  return length > kOtherSize * usual || usual > kOtherSize * length;
}

double share_of_other_edges(const Positions& pose, const Positions& other,
                            const Triangles& triangles) {
  const double of_pose = spread(pose, triangles), of_other = spread(other, triangles);
  if (!(of_pose > 0 && of_other > 0)) return 0;
  Eigen::Index unlike = 0;
  for (const auto& corners : triangles.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = corners[c], b = corners[(c + 1) % 3];
      unlike += is_other_size((pose.row(a) - pose.row(b)).norm() / of_pose,
                              (other.row(a) - other.row(b)).norm() / of_other);
    }
  }
  return static_cast<double>(unlike) /
         static_cast<double>(std::max<Eigen::Index>(1, triangles.size()));
}

std::vector<FrameShape> frame_shapes(const FrameSource& sequence, const Context& context) {
  const RestShape rest(sequence);
  const Frames first_pose = sequence.read(0, 1);
  const Positions start =
      PositionsView(first_pose.data(), sequence.vertices(), 3)(rest.surface, Eigen::all);
  const FrameNumbers numbers = over_frames(
      sequence, 0, kShapeNumbers,
      [&](int, const FrameBlock& block, FrameRows& of_block) {
        for (int row = 0; row < block.frames(); ++row) {
          const PositionsView pose = block.frame(row);
          FrameShape shape = shape_of(pose, rest);
          const Positions surface = pose(rest.surface, Eigen::all);
          shape.from_first = std::sqrt((surface - start).rowwise().squaredNorm().maxCoeff());
          of_block.row(row) = numbers_of(shape);
        }
      },
      context);
  std::vector<FrameShape> shapes;
  shapes.reserve(static_cast<std::size_t>(sequence.frames()));
  for (const auto& of_frame : numbers.of_each.rowwise()) shapes.push_back(shape_from(of_frame));
  return shapes;
}

namespace {

/// Frames that jump away and back, in a mesh of this size.
std::vector<int> jumping_frames(const std::vector<FrameShape>& shapes, double size) {
  constexpr double kFar = 0.2, kNear = 0.1;
  std::vector<int> jumping;
  for (std::size_t f = 1; f + 1 < shapes.size(); ++f) {
    const Eigen::Vector3d &before = shapes[f - 1].center, &after = shapes[f + 1].center;
    const bool stays = (after - before).norm() < kNear * size;
    if (stays && (shapes[f].center - (before + after) / 2).norm() > kFar * size) {
      jumping.push_back(static_cast<int>(f));
    }
  }
  return jumping;
}

/// Consecutive frames in which a vertex strays.
struct StrayRun {
  int first = 0, last = 0;
  /// Whether the vertex leaves and returns from one frame to the next. A sequence that begins or
  /// ends with several such frames may have changed its shape for good.
  bool is_spike = false;

  bool holds(int frame) const { return first <= frame && frame <= last; }
};

/// Frames around `frame` in which its vertex strays almost as far, by more than shape.stray -
/// least.
StrayRun stray_run(const FrameSource& sequence, const RestShape& rest, int frame,
                   const FrameShape& shape, double least) {
  StrayRun run{frame, frame};
  int leaps = 0, ends = 0;
  for (const int step : {-1, 1}) {
    double nearer = shape.stray;
    int& end = step < 0 ? run.first : run.last;
    for (int f = frame + step; f >= 0 && f < sequence.frames(); f += step) {
      const FrameBlock block(sequence, f, 1);
      const double there = rest.strays.distances(block.frame(0))[shape.stray_vertex];
      if (there <= shape.stray - least) {
        ++ends;
        if (nearer - there >= least) ++leaps;
        break;
      }
      nearer = there;
      end = f;
    }
  }
  const bool is_one = run.first == run.last;
  run.is_spike = leaps == ends && (ends == 2 || (is_one && ends == 1));
  return run;
}

/// Cache of the last run of each stray vertex. Frames must be queried in ascending order.
class StrayRuns {
 public:
  StrayRuns(const FrameSource& sequence, const RestShape& rest)
      : sequence_(sequence), rest_(rest) {}

  bool is_spike(int frame, const FrameShape& shape, double least) {
    const auto [found, is_new] = last_.try_emplace(shape.stray_vertex);
    StrayRun& run = found->second;
    if (is_new || !run.holds(frame)) run = stray_run(sequence_, rest_, frame, shape, least);
    return run.is_spike;
  }

 private:
  const FrameSource& sequence_;
  const RestShape& rest_;
  std::map<VertexIndex, StrayRun> last_;
};

/// "frames 7, 9 are `what`".
std::string told(const std::vector<int>& frames, const std::string& what) {
  const bool several = frames.size() > 1;
  return (several ? "frames " : "frame ") + listed(words_of(frames)) +
         (several ? " are " : " is ") + what;
}

}  // namespace

bool OddFrames::any() const {
  return !(of_other_size.empty() && mirrored.empty() && torn.empty() && jumping.empty() &&
           spiked.empty());
}

OddFrames odd_frames(const FrameSource& sequence, const std::vector<FrameShape>& shapes) {
  std::vector<double> spreads;
  spreads.reserve(shapes.size());
  for (const FrameShape& shape : shapes) spreads.push_back(shape.spread);
  OddFrames odd;
  odd.usual_spread = median(std::move(spreads));
  const RestShape rest(sequence);
  const FrameShape of_rest = shape_of(RestShape::view_of(sequence.rest()), rest);
  const double size = sequence.diameter();
  StrayRuns runs(sequence, rest);
  odd.jumping = jumping_frames(shapes, size);
  for (std::size_t f = 0; f < shapes.size(); ++f) {
    const FrameShape& shape = shapes[f];
    const auto frame = static_cast<int>(f);
    if (is_other_size(shape.spread, odd.usual_spread)) odd.of_other_size.push_back(frame);
    if (shape.is_mirrored) odd.mirrored.push_back(frame);
    // Another unit alone does not make a frame torn.
    const double unit = rest.of_spread > 0 ? std::max(1.0, shape.spread / rest.of_spread) : 1;
    if (shape.longest_edge > unit * std::max(size / 2, 2 * of_rest.longest_edge)) {
      odd.torn.push_back(frame);
    } else if (rest.triangles.rows() > 0 &&
               rest.strays.is_torn_off(shape.stray_vertex, shape.stray, size, unit) &&
               runs.is_spike(frame, shape, unit * StrayVertices::kStray * size)) {
      odd.spiked.push_back(frame);
    }
  }
  return odd;
}

std::vector<std::string> described(const OddFrames& odd, const std::vector<FrameShape>& shapes) {
  const auto of_first = [&shapes](const std::vector<int>& frames) -> const FrameShape& {
    return shapes[static_cast<std::size_t>(frames.front())];
  };
  std::vector<std::string> texts;
  if (!odd.of_other_size.empty()) {
    texts.push_back(told(odd.of_other_size, "of another size than the others: vertices lie ") +
                    readable(of_first(odd.of_other_size).spread) +
                    " from their mean there (RMS), " + readable(odd.usual_spread) + " elsewhere");
  }
  if (!odd.mirrored.empty()) {
    texts.push_back(told(odd.mirrored, "mirrored against the rest pose, or numbered otherwise"));
  }
  if (!odd.torn.empty()) {
    const FrameShape& shape = of_first(odd.torn);
    texts.push_back(told(odd.torn, "torn: vertices ") + std::to_string(shape.ends.first) + " and " +
                    std::to_string(shape.ends.second) + ", which share an edge, lie " +
                    readable(shape.longest_edge) + " apart");
  }
  if (!odd.spiked.empty()) {
    const FrameShape& shape = of_first(odd.spiked);
    texts.push_back(told(odd.spiked, "spiked: vertex ") + std::to_string(shape.stray_vertex) +
                    " alone lies " + readable(shape.stray) +
                    " farther from its neighbours than at rest, not so before and after");
  }
  if (!odd.jumping.empty()) {
    texts.push_back(told(odd.jumping, "far from the frames before and after"));
  }
  return texts;
}

StrayVertices::StrayVertices(const Positions& rest, const Triangles& triangles)
    : triangles_(triangles),
      at_rest_(from_neighbors(PositionsView(rest.data(), rest.rows(), 3))),
      edges_(longest_edges(rest, triangles)) {}

Eigen::VectorXd StrayVertices::from_neighbors(const PositionsView& pose) const {
  Positions sums = Positions::Zero(pose.rows(), 3);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(pose.rows());
  for (const auto& corners : triangles_.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      sums.row(corners[c]) += pose.row(corners[(c + 1) % 3]) + pose.row(corners[(c + 2) % 3]);
      counts[corners[c]] += 2;
    }
  }
  Eigen::VectorXd distances = Eigen::VectorXd::Zero(pose.rows());
  for (Eigen::Index v = 0; v < pose.rows(); ++v) {
    if (counts[v] > 0) distances[v] = (pose.row(v) - sums.row(v) / counts[v]).norm();
  }
  return distances;
}

Eigen::VectorXd StrayVertices::distances(const PositionsView& pose) const {
  return from_neighbors(pose) - at_rest_;
}

bool StrayVertices::is_torn_off(VertexIndex vertex, double distance, double size,
                                double scale) const {
  return distance > scale * kStray * size && distance > scale * edges_[vertex];
}

}  // namespace mimetra
