#include "transfer_bench.h"

#include <cmath>
#include <set>

#include <mimetra/regions/regions.h>
#include <mimetra/transfer/blendshape_transfer.h>
#include <mimetra/transfer/box_least_squares.h>
#include <mimetra/transfer/deformation_gradients.h>
#include <mimetra/transfer/folded_right_hand_side.h>
#include <mimetra/transfer/row_solver.h>
#include <mimetra/transfer/vertex_transfer.h>

#include "sparse_factor.h"

namespace mimetra::bench {
namespace {

constexpr const char* kGroup = "transfer";

/// Sizes that the work depends on.
struct Counts {
  double frames, vertices, triangles, expressions;

  double folded() const { return 3 * (vertices + triangles) * expressions; }
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

/// A^T A by its lower half; the basis is read and the folded matrices are written.
Work setup_work(const Counts& n) {
  const double basis = 3 * n.vertices * n.expressions;
  return {6 * n.triangles * n.expressions * n.expressions, 8 * (basis + n.folded())};
}

/// Two products with the folded matrices a frame.
Work folded_work(const Counts& n) {
  return {2 * n.frames * n.folded(), 8 * (n.frames * 3 * n.vertices + n.folded())};
}

/// One product with the Gram matrix a frame, which is what checking the solution takes.
Work box_work(const Counts& n) {
  return {2 * n.frames * n.expressions * n.expressions, 8 * n.frames * 2 * n.expressions};
}

Work both(const Work& a, const Work& b) {
  return {a.flops + b.flops, a.bytes + b.bytes};
}

/// The two halves of a frame of eq. 10: the right-hand side, and the solve in the box.
std::vector<Row> half_rows(const Subject& subject, const std::vector<int>& triangles,
                           const Size& size, const Settings& settings) {
  const Counts counts = counts_of(subject, triangles);
  const MeshSequence& performance = subject.performance;
  const DeformationGradients gradients(performance.rest(), subject.target.triangles(), triangles);
  const FoldedRightHandSide folded(performance.rest(), subject.target.triangles(), gradients,
                                   subject.target);
  const Eigen::MatrixXd h = folded(performance.positions());
  const Eigen::MatrixXd gram =
      BlendshapeTransfer(performance.rest(), subject.target, triangles).gram();
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(gram.rows());
  const Eigen::VectorXd upper = Eigen::VectorXd::Ones(gram.rows());
  const auto solve_all = [&] {
    Eigen::VectorXd beta = lower;
    for (Eigen::Index f = 0; f < h.rows(); ++f) {
      beta = box_least_squares(gram, h.row(f).transpose(), lower, upper, beta);
    }
  };
  const Rate each{"frame", counts.frames};
  return measured({{{kGroup, "folded right-hand side, one thread", size, folded_work(counts), each},
                    [&] { folded(performance.positions()); }},
                   {{kGroup, "box solve, one thread", size, box_work(counts), each}, solve_all}},
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
  const Size size{subject.name, performance.frames(), performance.vertices(), "D",
                  subject.target.expressions().size()};
  const BlendshapeTransfer transfer(performance.rest(), subject.target, triangles);
  std::vector<Row> rows = measured(
      {{{kGroup, kBlendshapeSetup + of_all, size, setup_work(counts)},
        [&] { const BlendshapeTransfer made(performance.rest(), subject.target, triangles); }},
       {{kGroup,
         kBlendshapeWeights + of_all,
         size,
         both(folded_work(counts), box_work(counts)),
         {"frame", counts.frames}},
        [&] { transfer.weights(performance); }}},
      settings.quick);
  if (with_halves) {
    for (Row& row : half_rows(subject, triangles, size, settings)) rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Row> vertex_rows(const Subject& subject, const Settings& settings) {
  const MeshSequence& performance = subject.performance;
  const Triangles& faces = performance.triangles();
  const std::vector<int> triangles = all_triangles(faces);
  const SparseFactor factor = sparse_factor(performance.vertices(), faces);
  const double frames = performance.frames(), coordinates = 3.0 * performance.vertices();
  const double sweeps = std::ceil(3 * frames / RowSolver::kWidth);
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
