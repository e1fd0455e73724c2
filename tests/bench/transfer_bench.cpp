#include "tests/bench/transfer_bench.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/bench/factor_size.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/vertex_pull.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra::bench {
namespace {

constexpr const char* kGroup = "transfer";

/// Sizes that the work depends on.
struct Counts {
  double frames, vertices, triangles, expressions;

  double basis() const { return 3 * vertices * expressions; }
};

Counts counts_of(const Subject& subject, const std::vector<int>& triangles) {
  std::set<int> used;
  for (const int t : triangles) {
    for (const int vertex : subject.target.triangles().row(t)) used.insert(vertex);
  }
  return {static_cast<double>(subject.performance.frames()), static_cast<double>(used.size()),
          static_cast<double>(triangles.size()),
          static_cast<double>(subject.target.expressions().size())};
}

/// A^T A by its lower half; the basis is read and copied.
Work setup_work(const Counts& n) {
  return {6 * n.triangles * n.expressions * n.expressions, 8 * 2 * n.basis()};
}

/// For each triangle its normal and what two vectors take of its frame, at three corners; then a
/// product with the basis.
Work right_hand_side_work(const Counts& n) {
  constexpr double kPerTriangle = 6 + 9 + 5 + 6 * 5 + 9;
  return {n.frames * (kPerTriangle * n.triangles + 2 * n.basis()),
          8 * (n.frames * 3 * n.vertices + n.basis())};
}

/// One product with the Gram matrix a frame, which is what checking the solution takes.
Work box_work(const Counts& n) {
  return {2 * n.frames * n.expressions * n.expressions, 8 * n.frames * 2 * n.expressions};
}

/// The right-hand sides of a performance, on one thread.
class RightHandSides {
 public:
  RightHandSides(const Subject& subject, const std::vector<int>& triangles)
      : frames_(subject.performance.positions()),
        expressions_(subject.target.expressions().size()),
        of_frames_(
            subject.performance.rest(),
            DeformationGradients(subject.performance.rest(), subject.target.triangles(), triangles),
            subject.target, EdgeSum::all) {}

  Eigen::MatrixXd operator()() const {
    Eigen::MatrixXd h(frames_.rows(), expressions_);
    for (int first = 0; first < h.rows(); first += RightHandSide::kLanes) {
      const auto count = std::min<Eigen::Index>(RightHandSide::kLanes, h.rows() - first);
      h.middleRows(first, count) = of_frames_(frames_.middleRows(first, count));
    }
    return h;
  }

 private:
  Frames frames_;
  Eigen::Index expressions_;
  RightHandSide of_frames_;
};

Size size_of(const Subject& subject) {
  return {subject.name, subject.performance.frames(), subject.performance.vertices(), "D",
          subject.target.expressions().size()};
}

Case right_hand_side_case(const Subject& subject, const std::vector<int>& triangles) {
  const Counts counts = counts_of(subject, triangles);
  const auto sides = std::make_shared<const RightHandSides>(subject, triangles);
  return {{kGroup,
           "right-hand sides, one thread",
           size_of(subject),
           right_hand_side_work(counts),
           {"frame", counts.frames}},
          [sides] { (*sides)(); }};
}

/// The two halves of a frame of eq. 10: the right-hand side, and the solve in the box.
std::vector<Row> half_rows(const Subject& subject, const std::vector<int>& triangles,
                           const Settings& settings) {
  const Counts counts = counts_of(subject, triangles);
  const Eigen::MatrixXd h = RightHandSides(subject, triangles)();
  const Eigen::MatrixXd gram =
      BlendshapeTransfer(subject.performance.rest(), subject.target, triangles).gram();
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(gram.rows());
  const Eigen::VectorXd upper = Eigen::VectorXd::Ones(gram.rows());
  const auto solve_all = [&] {
    Eigen::VectorXd beta = lower;
    for (Eigen::Index f = 0; f < h.rows(); ++f) {
      beta = box_least_squares(gram, h.row(f).transpose(), lower, upper, beta);
    }
  };
  return measured({right_hand_side_case(subject, triangles),
                   {{kGroup,
                     "box solve, one thread",
                     size_of(subject),
                     box_work(counts),
                     {"frame", counts.frames}},
                    solve_all}},
                  settings.quick);
}

}  // namespace

std::vector<Row> blendshape_rows(const Subject& subject, double share, bool with_halves,
                                 const Settings& settings) {
  const MeshSequence& performance = subject.performance;
  const std::vector<int> triangles = share < 1 ? triangles_around_motion(subject, share)
                                               : all_triangles(subject.target.triangles());
  const Counts counts = counts_of(subject, triangles);
  const std::string of_all =
      share < 1 ? ", " + std::to_string(std::lround(100 * share)) + " % of triangles" : "";
  const Size size = size_of(subject);
  const BlendshapeTransfer transfer(performance.rest(), subject.target, triangles);
  std::vector<Row> rows = measured(
      {{{kGroup, kBlendshapeSetup + of_all, size, setup_work(counts)},
        [&] { const BlendshapeTransfer made(performance.rest(), subject.target, triangles); }},
       {{kGroup,
         kBlendshapeWeights + of_all,
         size,
         both(right_hand_side_work(counts), box_work(counts)),
         {"frame", counts.frames}},
        [&] { transfer.weights(performance); }}},
      settings.quick);
  if (with_halves) {
    for (Row& row : half_rows(subject, triangles, settings)) rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Case> right_hand_side_cases(const Subject& subject) {
  return {right_hand_side_case(subject, all_triangles(subject.target.triangles()))};
}

std::vector<Row> vertex_rows(const Subject& subject, const Settings& settings) {
  const MeshSequence& performance = subject.performance;
  const Triangles& faces = performance.triangles();
  const std::vector<int> triangles = all_triangles(faces);
  const FactorSize factor = factor_size(performance.vertices(), faces);
  const double frames = performance.frames(), coordinates = 3.0 * performance.vertices();
  const double sweeps = std::ceil(3 * frames / VertexPull::kWidth);
  const Work setup{factor.factor_flops, factor.bytes()};
  const Work sweep{3 * frames * factor.solve_flops(),
                   passes(factor.bytes(), sweeps, settings.machine) + 16 * frames * coordinates};
  const Size size{subject.name, performance.frames(), performance.vertices()};
  const auto prepared = [&] {
    return VertexTransfer(performance.rest(), subject.target.neutral(), faces, triangles);
  };
  const VertexTransfer transfer = prepared();
  return measured({{{kGroup, kVertexSetup, size, setup}, [&] { prepared(); }},
                   {{kGroup, kVertexFrames, size, sweep, {"frame", frames}},
                    [&] { transfer.frames(performance); }}},
                  settings.quick);
}

}  // namespace mimetra::bench
