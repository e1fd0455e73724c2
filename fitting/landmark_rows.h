#pragma once

#include <vector>

#include "fitting/affine_camera.h"
#include "toolkit/model/morphable_model.h"

/// The few rows of a model that landmarks need, folded so that no camera costs a normal matrix
/// over landmarks. Internal to landmark_fitter.h.
namespace mimetra {

/// Displacements of n landmarks by the columns of a basis, and their products in pairs of axes.
class BasisRows {
 public:
  using Axes = Eigen::Matrix<double, 2, 3>;

  /// `rows` 3n x D: x of all landmarks, then y, then z.
  explicit BasisRows(Eigen::MatrixXd rows);

  Eigen::Index size() const { return rows_.cols(); }
  const Eigen::MatrixXd& rows() const { return rows_; }
  ModelPoints displacement(const Eigen::VectorXd& coefficients) const;

  /// A^T A for A (2n x D), what a camera with the linear part C sees of the basis: lower triangle,
  /// column after column. It is linear in M = C^T C: sums over frames go into M, or over these.
  Eigen::VectorXd packed_gram(const Eigen::Matrix3d& M) const;
  /// A^T r for residuals r (n x 2).
  Eigen::VectorXd transposed_product(const Axes& C, const ImagePoints& r) const;

 private:
  Eigen::MatrixXd rows_;
  /// One column for each of the products xx, yy, zz, xy, xz, yz, packed like packed_gram().
  Eigen::Matrix<double, Eigen::Dynamic, 6> products_;
};

/// The symmetric matrix (D x D) of a packed lower triangle; its upper part is not set.
Eigen::MatrixXd lower_triangle(const Eigen::VectorXd& packed, Eigen::Index size);

/// A model at n landmarks: mean, identities, expressions and both side by side.
struct LandmarkRows {
  LandmarkRows(const MorphableModel& model, const std::vector<int>& vertices);
  /// Those of some landmarks only.
  LandmarkRows(const LandmarkRows& all, const std::vector<Eigen::Index>& some);

  std::vector<Eigen::Index> landmarks;  ///< which of all they are, ascending
  ModelPoints mean;
  BasisRows identities;
  BasisRows expressions;
  BasisRows both;
};

}  // namespace mimetra
