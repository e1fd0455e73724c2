#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fitting/landmark_fitter.h"

/// Whether what was fitted can be a person. Internal to fit_operation.h.
namespace mimetra {

/// Of a fitted identity.
struct IdentityVerdict {
  double alpha_rms = 0;  ///< in standard deviations of the model
  double alpha_max = 0;  ///< the largest, by size
  int flipped = 0;       ///< triangles of the neutral that are turned against the mean face
  /// True where a person of the model is not to be expected.
  bool is_doubtful() const;
};

IdentityVerdict verdict_of(const MorphableModel& model, const Eigen::VectorXd& alpha);

/// Distances of the vertices of two neutrals, as shares of the longest side of the model's mean.
struct NeutralDistance {
  double mean = 0;
  double largest = 0;
};

NeutralDistance neutral_distance(const MorphableModel& model, const Eigen::VectorXd& a,
                                 const Eigen::VectorXd& b);

/// How an expression is used in a clip.
struct ExpressionUse {
  double mean = 0;
  double at_zero = 0;  ///< share of the frames in which it is at its lower bound
  double at_one = 0;   ///< at its upper bound
  /// True where it is there all the time, as if it were a part of the face.
  bool is_constant() const;
};

/// Of each column of `beta` (F x D), bounds 0 and 1.
std::vector<ExpressionUse> expression_use(const Eigen::MatrixXd& beta);

/// How many of the landmarks at `vertices` are on a side of the mesh (N x 3) that a camera does not
/// see, by the normals there.
int averted_landmarks(const Positions& mesh, const Triangles& triangles,
                      const std::vector<int>& vertices, const AffineCamera& camera);

}  // namespace mimetra
