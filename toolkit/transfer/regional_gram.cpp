#include "toolkit/transfer/regional_gram.h"

#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/product_blocking.h"

namespace mimetra {

namespace {

/// Where a field is not 0, and what its edges are, gathered at the vertices: the product of two
/// fields over edges is the sum over vertices of one's displacement and the other's gathered edges.
class GatheredFields {
 public:
  GatheredFields(const BlendshapeModel& target, const Eigen::VectorXd& shares,
                 const std::vector<int>& triangles, EdgeSum sum)
      : row_of_vertex_(target.vertices(), -1) {
    const Triangles& faces = target.triangles();
    std::vector<int> touched;
    for (const int t : triangles) {
      const auto corners = faces.row(t);
      if (shares[corners[0]] == 0 && shares[corners[1]] == 0 && shares[corners[2]] == 0) continue;
      touched.push_back(t);
      for (const VertexIndex v : corners) {
        if (row_of_vertex_[v] < 0) row_of_vertex_[v] = count_++;
      }
    }
    const Eigen::Matrix2d product = edge_product(sum);
    const Eigen::MatrixXd& fields = target.expressions().displacements;
    gathered_ = Eigen::MatrixXd::Zero(3 * count_, fields.cols());
    for (Eigen::Index j = 0; j < fields.cols(); ++j) {
      const PositionsView field(fields.col(j).data(), target.vertices(), 3);
      for (const int t : touched) {
        const auto corners = faces.row(t);
        const auto at = [&](int corner) {
          return (shares[corners[corner]] * field.row(corners[corner])).transpose().eval();
        };
        Edges edges;
        edges << at(1) - at(0), at(2) - at(0);
        const Edges pull = edges.lazyProduct(product);
        gathered_.col(j).segment<3>(row(corners[0])) -= pull.rowwise().sum();
        gathered_.col(j).segment<3>(row(corners[1])) += pull.col(0);
        gathered_.col(j).segment<3>(row(corners[2])) += pull.col(1);
      }
    }
  }

  /// With the fields of another region (D x D): theirs are the rows.
  Eigen::MatrixXd product(const Eigen::MatrixXd& fields, const RegionShares& shares,
                          Eigen::Index region) const {
    std::vector<std::pair<VertexIndex, double>> common;
    for (RegionShares::InnerIterator share(shares, region); share; ++share) {
      const auto vertex = static_cast<VertexIndex>(share.index());
      if (row_of_vertex_[vertex] >= 0) common.emplace_back(vertex, share.value());
    }
    const auto rows = static_cast<Eigen::Index>(3 * common.size());
    Eigen::MatrixXd theirs(rows, fields.cols()), ours(rows, fields.cols());
    for (Eigen::Index i = 0; i < rows / 3; ++i) {
      const auto& [vertex, share] = common[i];
      theirs.middleRows<3>(3 * i) = share * fields.middleRows<3>(3 * vertex);
      ours.middleRows<3>(3 * i) = gathered_.middleRows<3>(row(vertex));
    }
    return theirs.transpose() * ours;
  }

 private:
  Eigen::Index row(VertexIndex vertex) const { return 3 * row_of_vertex_[vertex]; }

  std::vector<int> row_of_vertex_;
  Eigen::Index count_ = 0;
  Eigen::MatrixXd gathered_;  // 3 rows a vertex
};

}  // namespace

Eigen::MatrixXd regional_gram(const BlendshapeModel& target, const RegionShares& shares,
                              const std::vector<int>& triangles, EdgeSum sum,
                              const Context& context) {
  fix_product_blocking();
  const Eigen::MatrixXd& fields = target.expressions().displacements;
  const Eigen::Index D = fields.cols(), R = shares.cols();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(R * D, R * D);
  const auto fill = [&](int s) {
    const GatheredFields gathered(target, shares.col(s), triangles, sum);
    for (Eigen::Index r = 0; r <= s; ++r) {
      const Eigen::MatrixXd block = gathered.product(fields, shares, r);
      gram.block(r * D, s * D, D, D) = block;
      gram.block(s * D, r * D, D, D) = block.transpose();
    }
    // Symmetric to the last bit, as a solver may read either half.
    const Eigen::MatrixXd own = gram.block(s * D, s * D, D, D);
    gram.block(s * D, s * D, D, D) = (own + own.transpose()) / 2;
  };
  parallel_for(static_cast<int>(R), fill, context);
  return gram;
}

}  // namespace mimetra
