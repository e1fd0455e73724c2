#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "toolkit/mesh/mesh_sequence.h"

/// The decomposition as the paper writes it: dense, with the residual as a matrix, no products
/// kept.
///
/// [Neumann et al. Sparse Localized Deformation Components. ACM TOG 32(6), 2013], section 4
namespace mimetra::test {

struct LiteralProblem {
  Eigen::MatrixXd X;  ///< F x 3N, scaled
  int count;
  double sparsity, rho;
  int iterations, admm_iterations;
  bool nonnegative, literal_sign;
  std::function<Eigen::VectorXd(int)> support;
};

struct LiteralResult {
  Eigen::MatrixXd W_start, C_start;
  std::vector<int> centers_start;
  /// After each iteration; the centres are those whose support maps it used.
  std::vector<Eigen::MatrixXd> W, C;
  std::vector<double> energy, data_term;
  std::vector<std::vector<int>> centers;
};

inline Eigen::VectorXd literal_projection(Eigen::VectorXd w, bool nonnegative) {
  if (nonnegative) w = w.cwiseMax(0);
  const double largest = w.cwiseAbs().maxCoeff();
  if (largest > 0) w /= largest;
  return w;
}

inline int literal_strongest(const Eigen::MatrixXd& motion) {
  int strongest = 0;
  double largest = -1;
  for (int v = 0; v < motion.cols() / 3; ++v) {
    const double energy = motion.middleCols(3 * v, 3).squaredNorm();
    if (energy > largest) {
      largest = energy;
      strongest = v;
    }
  }
  return strongest;
}

inline Eigen::VectorXd literal_start_weights(const LiteralProblem& problem,
                                             const Eigen::VectorXd& w) {
  const Eigen::VectorXd plus = literal_projection(w, problem.nonnegative);
  const Eigen::VectorXd minus = literal_projection(-w, problem.nonnegative);
  if (problem.literal_sign) return plus.norm() > minus.norm() ? plus : minus;
  double plus_energy = 0, minus_energy = 0;
  for (const double x : w) (x > 0 ? plus_energy : minus_energy) += x * x;
  return plus_energy > minus_energy ? plus : minus;
}

inline void literal_start(const LiteralProblem& problem, LiteralResult& result) {
  Eigen::MatrixXd R = problem.X;
  result.W_start = Eigen::MatrixXd::Zero(R.rows(), problem.count);
  result.C_start = Eigen::MatrixXd::Zero(problem.count, R.cols());
  for (int k = 0; k < problem.count; ++k) {
    const int center = literal_strongest(R);
    const Eigen::MatrixXd at_center = R.middleCols(3 * center, 3);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(at_center, Eigen::ComputeThinU);
    const Eigen::VectorXd w =
        literal_start_weights(problem, svd.matrixU().col(0) * svd.singularValues()[0]);
    Eigen::RowVectorXd c = w.transpose() * R / w.squaredNorm();
    const Eigen::VectorXd support = problem.support(center);
    for (int i = 0; i < c.size(); ++i) c[i] *= 1 - support[i / 3];
    R -= w * c;
    result.W_start.col(k) = w;
    result.C_start.row(k) = c;
    result.centers_start.push_back(center);
  }
}

inline Eigen::MatrixXd literal_weights(const LiteralProblem& problem, Eigen::MatrixXd W,
                                       const Eigen::MatrixXd& C) {
  for (int k = 0; k < problem.count; ++k) {
    const double energy = C.row(k).squaredNorm();
    if (energy <= 1e-8) {
      W.col(k).setZero();
      continue;
    }
    const Eigen::MatrixXd R = problem.X - W * C + W.col(k) * C.row(k);
    W.col(k) = literal_projection(R * C.row(k).transpose() / energy, problem.nonnegative);
  }
  return W;
}

/// Z_ki = max(0, 1 - Lambda_ki / (rho |v_ki|)) v_ki.
inline Eigen::MatrixXd literal_shrinkage(const Eigen::MatrixXd& V, const Eigen::MatrixXd& Lambda,
                                         double rho) {
  Eigen::MatrixXd Z = V;
  for (int k = 0; k < V.rows(); ++k) {
    for (int i = 0; i < Lambda.cols(); ++i) {
      const double length = V.row(k).segment(3 * i, 3).norm();
      if (length == 0) continue;
      Z.row(k).segment(3 * i, 3) *= std::max(0.0, 1 - Lambda(k, i) / (rho * length));
    }
  }
  return Z;
}

inline LiteralResult literal_decomposition(const LiteralProblem& problem) {
  LiteralResult result;
  literal_start(problem, result);
  const Eigen::MatrixXd& X = problem.X;
  Eigen::MatrixXd W = result.W_start, C = result.C_start;
  Eigen::MatrixXd U = Eigen::MatrixXd::Zero(C.rows(), C.cols());
  for (int iteration = 0; iteration < problem.iterations; ++iteration) {
    W = literal_weights(problem, W, C);
    Eigen::MatrixXd Lambda(problem.count, X.cols() / 3);
    std::vector<int>& centers = result.centers.emplace_back();
    for (int k = 0; k < problem.count; ++k) {
      centers.push_back(literal_strongest(C.row(k)));
      Lambda.row(k) = problem.sparsity * problem.support(centers.back());
    }
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(problem.count, problem.count);
    const Eigen::MatrixXd system = W.transpose() * W + problem.rho * identity;
    Eigen::MatrixXd Z = C;
    for (int step = 0; step < problem.admm_iterations; ++step) {
      C = system.fullPivLu().solve(W.transpose() * X + problem.rho * (Z - U));
      Z = literal_shrinkage(C + U, Lambda, problem.rho);
      U += C - Z;
    }
    C = Z;
    double penalty = 0;
    for (int k = 0; k < problem.count; ++k) {
      for (int i = 0; i < Lambda.cols(); ++i) {
        penalty += Lambda(k, i) * C.row(k).segment(3 * i, 3).norm();
      }
    }
    result.data_term.push_back((X - W * C).squaredNorm());
    result.energy.push_back(result.data_term.back() + penalty);
    result.W.push_back(W);
    result.C.push_back(C);
  }
  return result;
}

}  // namespace mimetra::test
