#include "toolkit/report/coded_poses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "toolkit/mesh/product_blocking.h"
#include "toolkit/splocs/time_basis.h"

namespace mimetra {

namespace {

/// What poses are coded in: steps from a centre.
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

/// A pose in steps (1 x 3N).
Eigen::RowVectorXd in_steps(const PositionsView& pose, const Grid& grid) {
  const Positions steps = (pose.rowwise() - grid.center) / grid.step;
  return steps.reshaped<Eigen::RowMajor>().transpose();
}

/// \pre `numbers` are at most 32767
StepMatrix rounded(const Eigen::Ref<const Frames>& numbers) {
  return numbers.unaryExpr(
      [](double number) { return static_cast<std::int16_t>(std::lround(number)); });
}

/// How the frames lie from the rest pose, in steps.
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

/// Where the mixtures are off by more than a step.
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
  // A sketch that finds few poses has more of them.
  const Eigen::Index sketched = std::max<Eigen::Index>(64, 2 * most);
  const auto found =
      time_basis(X, norm2, std::min(1.0, tolerance), sketched, context.without_ranks());
  if (!found || found->B.rows() > most) return std::nullopt;

  // The largest weight of each pose becomes 1.
  const Eigen::RowVectorXd largest =
      found->Q.cwiseAbs().colwise().maxCoeff().cwiseMax(std::numeric_limits<double>::min());
  const Frames weights = found->Q.array().rowwise() / largest.array();
  const Frames basis = largest.transpose().asDiagonal() * found->B.frames();
  MixedPoses result{grid.center, grid.step, {}, {}, {}, {}, {}};
  const PositionsView rest(sequence.rest().data(), sequence.vertices(), 3);
  result.rest = rounded(MixedPoses::kStepsOfRest * in_steps(rest, grid));
  // Rounding errs by a step's share of 1 / sqrt(12), in each of the poses.
  result.basis_step = std::max(kOffByRounding * std::sqrt(12 / static_cast<double>(basis.rows())),
                               basis.cwiseAbs().maxCoeff() / MixedPoses::kWeightOfOne);
  result.basis = rounded(basis / result.basis_step);
  result.weights = rounded(MixedPoses::kWeightOfOne * weights);
  result.corrections = corrections_of(result, sequence, frames);
  return result;
}

}  // namespace mimetra
