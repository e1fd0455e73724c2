#include "toolkit/mesh/rest_beyond_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

constexpr int kFrames = 128;
constexpr std::size_t kVertices = 1000;

/// At most `most` of the numbers 0 .. count - 1, evenly spaced.
std::vector<int> spread_out(int count, int most) {
  const int taken = std::min(count, most);
  std::vector<int> chosen(static_cast<std::size_t>(taken));
  for (int i = 0; i < taken; ++i) {
    chosen[static_cast<std::size_t>(i)] =
        static_cast<int>(std::int64_t{i} * (count - 1) / std::max(1, taken - 1));
  }
  return chosen;
}

std::vector<VertexIndex> looked_at(const FrameSource& sequence) {
  const std::vector<VertexIndex> surface = surface_vertices(sequence.rest(), sequence.triangles());
  const std::size_t step = std::max<std::size_t>(1, (surface.size() + kVertices - 1) / kVertices);
  std::vector<VertexIndex> chosen;
  for (std::size_t i = 0; i < surface.size(); i += step) chosen.push_back(surface[i]);
  return chosen;
}

/// Small translations, rotations and scaling of a pose (x, y, z of each vertex), as seven rows.
FrameRows whole_ways(const Eigen::RowVectorXd& pose) {
  const PositionsView positions(pose.data(), pose.size() / 3, 3);
  const Positions from_center = positions.rowwise() - positions.colwise().mean();
  FrameRows ways(7, pose.size());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::RowVector3d unit = Eigen::RowVector3d::Unit(axis);
    const Positions shift = unit.replicate(from_center.rows(), 1);
    Positions turn(from_center.rows(), 3);
    for (Eigen::Index v = 0; v < turn.rows(); ++v) turn.row(v) = unit.cross(from_center.row(v));
    ways.row(axis) = shift.reshaped<Eigen::RowMajor>().transpose();
    ways.row(3 + axis) = turn.reshaped<Eigen::RowMajor>().transpose();
  }
  ways.row(6) = from_center.reshaped<Eigen::RowMajor>().transpose();
  return ways;
}

/// Orthonormal basis, as rows, of the space that `rows` span.
FrameRows spanned_by(const FrameRows& rows) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(rows * rows.transpose());
  // Directions with a smaller share of the energy are rounding.
  constexpr double kRounding = 1e-10;
  const Eigen::VectorXd& energies = solver.eigenvalues();
  const Eigen::Index last = energies.size() - 1;
  Eigen::Index first = 0;
  while (first <= last && energies[first] <= kRounding * energies[last]) ++first;
  const Eigen::Index kept = last + 1 - first;
  return energies.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal() *
         solver.eigenvectors().rightCols(kept).transpose() * rows;
}

/// Mixtures of poses, each a row of coordinates; gives the rest of other poses beyond them.
class Mixtures {
 public:
  explicit Mixtures(const Eigen::Ref<const FrameRows>& poses) : mean_(poses.colwise().mean()) {
    const FrameRows moved = poses.rowwise() - mean_;
    spread2_ = moved.squaredNorm() / static_cast<double>(moved.rows());
    of_frames_ = spanned_by(moved);
    FrameRows ways = whole_ways(mean_);
    ways.rowwise().normalize();
    of_whole_ = spanned_by(ways - (ways * of_frames_.transpose()) * of_frames_);
  }

  FrameRows beyond(const Eigen::Ref<const FrameRows>& poses) const {
    const FrameRows moved = poses.rowwise() - mean_;
    const FrameRows left = moved - (moved * of_frames_.transpose()) * of_frames_;
    return left - (left * of_whole_.transpose()) * of_whole_;
  }

  /// Mean over the frames of the squared distance from their mean.
  double spread2() const { return spread2_; }

 private:
  Eigen::RowVectorXd mean_;
  FrameRows of_frames_, of_whole_;
  double spread2_ = 0;
};

}  // namespace

bool RestBeyondFrames::is_of_other_face() const {
  // With few frames, little of what a face does is known, so the limit rises.
  constexpr double kSeen = 0.0016, kTelling = 120, kNoise = 3, kEverywhere = 0.2;
  constexpr int kFew = 10;
  const double shown = std::min(1.0, frames / kTelling);
  // A face that holds one expression is also far from its neutral, but less far.
  constexpr double kHeld = 4, kFar = 0.1;
  const bool may_be_held = of_rest > kHeld * spread && of_rest < kFar;
  return frames >= kFew && of_rest > kSeen / (shown * shown) && of_rest > kNoise * of_frames &&
         least > kEverywhere * of_rest && !may_be_held;
}

std::string described(const RestBeyondFrames& rest) {
  return "the rest pose is likely another face's: it lies " + readable(100 * rest.of_rest, 2) +
         " % of the size (RMS) beyond all mixtures of the frames, and what the two faces differ by "
         "counts as deformation";
}

RestBeyondFrames rest_beyond_frames(const std::shared_ptr<const FrameSource>& sequence,
                                    const Context& context) {
  constexpr int kFewest = 4;
  RestBeyondFrames found;
  found.frames = sequence->frames();
  const std::vector<VertexIndex> vertices = looked_at(*sequence);
  const double size = sequence->diameter();
  if (found.frames < kFewest || vertices.empty() || size <= 0) return found;
  const auto row_of = [&vertices](const Eigen::Ref<const Positions>& pose) -> Eigen::RowVectorXd {
    return Positions(pose(vertices, Eigen::all)).reshaped<Eigen::RowMajor>().transpose();
  };
  const auto chosen = selected(sequence, spread_out(found.frames, kFrames));
  const auto columns = 3 * static_cast<Eigen::Index>(vertices.size());
  const FrameRows poses = over_frames(
                              *chosen, 0, columns,
                              [&](int, const FrameBlock& block, FrameRows& rows) {
                                for (int row = 0; row < block.frames(); ++row)
                                  rows.row(row) = row_of(block.frame(row));
                              },
                              context)
                              .of_each;

  const auto every_other = [&poses](Eigen::Index first) -> FrameRows {
    return poses(Eigen::seq(first, poses.rows() - 1, 2), Eigen::all);
  };
  const Mixtures mixtures(every_other(0));
  const auto count = static_cast<double>(vertices.size());
  const auto share = [size, count](double squared) { return std::sqrt(squared / count) / size; };
  const FrameRows others = mixtures.beyond(every_other(1));
  found.of_frames = share(others.squaredNorm() / static_cast<double>(others.rows()));
  found.spread = share(mixtures.spread2());
  const Positions left =
      mixtures.beyond(row_of(sequence->rest())).reshaped<Eigen::RowMajor>(vertices.size(), 3);
  found.of_rest = share(left.squaredNorm());
  Eigen::VectorXd distances = left.rowwise().norm();
  const auto tenth = distances.begin() + distances.size() / 10;
  std::nth_element(distances.begin(), tenth, distances.end());
  found.least = *tenth / size;
  return found;
}

}  // namespace mimetra
