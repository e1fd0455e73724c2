#include "toolkit/transfer/edges.h"

#include <algorithm>
#include <cmath>

namespace mimetra {

namespace {

constexpr std::size_t kTrianglesPerBlock = 256;

/// Square of the least visible share of a column's motion, 1e-5. A column that moves less than this
/// share in L does not move there. Zeros that single precision files round lie below.
constexpr double kUnseenShare = 1e-10;

}  // namespace

Eigen::MatrixXd edge_rows(const BlendshapeModel& target, std::span<const int> triangles,
                          EdgeSum sum) {
  const Eigen::Matrix2d factor = edge_factor(sum);
  const Eigen::MatrixXd& basis = target.expressions().displacements;
  Eigen::MatrixXd rows(6 * triangles.size(), basis.cols());
  for (Eigen::Index j = 0; j < basis.cols(); ++j) {
    const PositionsView field(basis.col(j).data(), target.vertices(), 3);
    Eigen::Map<Eigen::Matrix<double, 6, Eigen::Dynamic>> column(rows.col(j).data(), 6,
                                                                Eigen::Index(triangles.size()));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Edges edges = edges_of(field, target.triangles(), triangles[i]).lazyProduct(factor);
      column.col(Eigen::Index(i)) = edges.reshaped();
    }
  }
  return rows;
}

namespace {

/// Calls `work` with the edge_rows() of one block of triangles after the other. Blocks are small
/// enough to stay in cache with all expressions.
void for_edge_rows(const BlendshapeModel& target, std::span<const int> triangles, EdgeSum sum,
                   const std::function<void(const Eigen::MatrixXd&)>& work) {
  for (std::size_t first = 0; first < triangles.size(); first += kTrianglesPerBlock) {
    const std::size_t size = std::min(kTrianglesPerBlock, triangles.size() - first);
    work(edge_rows(target, triangles.subspan(first, size), sum));
  }
}

}  // namespace

Eigen::MatrixXd gram_matrix(const BlendshapeModel& target, std::span<const int> triangles,
                            EdgeSum sum, const Eigen::VectorXd& weights) {
  const Eigen::Index d = target.expressions().size();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(d, d);
  auto next = triangles.begin();
  for_edge_rows(target, triangles, sum, [&](const Eigen::MatrixXd& rows) {
    if (weights.size() == 0) {
      gram.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
      return;
    }
    Eigen::MatrixXd weighted = rows;
    for (Eigen::Index first = 0; first < rows.rows(); first += 6) {
      weighted.middleRows<6>(first) *= std::sqrt(weights[*next++]);
    }
    gram.selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
  });
  return gram.selfadjointView<Eigen::Lower>();
}

Eigen::VectorXd gram_diagonal(const BlendshapeModel& target, std::span<const int> triangles,
                              EdgeSum sum) {
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(target.expressions().size());
  for_edge_rows(target, triangles, sum, [&diagonal](const Eigen::MatrixXd& rows) {
    diagonal += rows.colwise().squaredNorm().transpose();
  });
  return diagonal;
}

bool moves_there(double part, double all) {
  return part > kUnseenShare * all;
}

Eigen::VectorXd motion_of_triangles(const BlendshapeModel& target,
                                    const Eigen::Ref<const Eigen::VectorXd>& field, EdgeSum sum) {
  const Eigen::Matrix2d factor = edge_factor(sum);
  const PositionsView displacements(field.data(), target.vertices(), 3);
  Eigen::VectorXd motion(target.triangles().rows());
  for (int t = 0; t < motion.size(); ++t) {
    motion[t] = edges_of(displacements, target.triangles(), t).lazyProduct(factor).squaredNorm();
  }
  return motion;
}

}  // namespace mimetra
