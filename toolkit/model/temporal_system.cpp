#include "toolkit/model/temporal_system.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>

namespace mimetra {

namespace {

using Column = Eigen::Map<Eigen::VectorXd>;
using ConstColumn = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

TemporalSystem::TemporalSystem(std::vector<Eigen::MatrixXd> grams, SecondDifferences differences,
                               double mu)
    : grams_(std::move(grams)),
      differences_(std::move(differences)),
      frames_(differences_.rows() + 2),
      mu_(mu) {}

const Eigen::MatrixXd& TemporalSystem::gram(Eigen::Index frame) const {
  return grams_[grams_.size() == 1 ? 0 : frame];
}

Eigen::Index TemporalSystem::size(Eigen::Index block) const {
  return std::min<Eigen::Index>(2, frames_ - first(block));
}

/// Entry (a, b) of mu D2^T D2: row f of D2 has three entries, at frames f, f + 1 and f + 2.
double TemporalSystem::coupling(Eigen::Index a, Eigen::Index b) const {
  const Eigen::Index low = std::max<Eigen::Index>({0, a - 2, b - 2});
  const Eigen::Index high = std::min({a, b, frames_ - 3});
  double sum = 0;
  for (Eigen::Index f = low; f <= high; ++f) {
    sum += differences_(f, a - f) * differences_(f, b - f);
  }
  return mu_ * sum;
}

TemporalSystem::Rows TemporalSystem::product(const Rows& x) const {
  Rows result(x.rows(), x.cols());
  if (grams_.size() == 1) {
    result.noalias() = x * grams_.front();
  } else {
    for (Eigen::Index f = 0; f < frames_; ++f) result.row(f) = x.row(f) * grams_[f];
  }
  const Eigen::Index n = differences_.rows();
  const Rows second = mu_ * differences_of(differences_, x);
  for (int i = 0; i < 3; ++i) result.middleRows(i, n) += differences_.col(i).asDiagonal() * second;
  return result;
}

TemporalSystem::Rows TemporalSystem::diagonal() const {
  Rows result(frames_, grams_.front().cols());
  for (Eigen::Index f = 0; f < frames_; ++f) {
    result.row(f) = gram(f).diagonal().transpose().array() + coupling(f, f);
  }
  return result;
}

double TemporalSystem::norm() const {
  double of_grams = 0, of_couplings = 0;
  for (const Eigen::MatrixXd& gram : grams_) {
    of_grams = std::max(of_grams, gram.lpNorm<Eigen::Infinity>());
  }
  for (Eigen::Index a = 0; a < frames_; ++a) {
    double sum = 0;
    for (Eigen::Index b = std::max<Eigen::Index>(0, a - 2); b < std::min(frames_, a + 3); ++b) {
      sum += std::abs(coupling(a, b));
    }
    of_couplings = std::max(of_couplings, sum);
  }
  return of_grams + of_couplings;
}

Eigen::MatrixXd TemporalSystem::diagonal_block(Eigen::Index block, const Rows& extra,
                                               const Rows& free) const {
  const Eigen::Index d = grams_.front().rows(), start = first(block), frames = size(block);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(frames * d, frames * d);
  for (Eigen::Index a = 0; a < frames; ++a) {
    result.block(a * d, a * d, d, d) = gram(start + a);
    for (Eigen::Index b = 0; b < frames; ++b) {
      result.block(a * d, b * d, d, d).diagonal().array() += coupling(start + a, start + b);
    }
  }
  const ConstColumn mask(free.row(start).data(), frames * d);
  result = mask.asDiagonal() * result * mask.asDiagonal();
  result.diagonal() += ConstColumn(extra.row(start).data(), frames * d);
  result.diagonal().array() += 1 - mask.array();
  return result;
}

Eigen::MatrixXd TemporalSystem::lower_block(Eigen::Index block, const Rows& free) const {
  const Eigen::Index d = grams_.front().rows(), here = first(block), next = first(block + 1);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size(block + 1) * d, size(block) * d);
  for (Eigen::Index a = 0; a < size(block + 1); ++a) {
    for (Eigen::Index b = 0; b < size(block); ++b) {
      result.block(a * d, b * d, d, d).diagonal() =
          coupling(next + a, here + b) * free.row(next + a).cwiseProduct(free.row(here + b));
    }
  }
  return result;
}

void TemporalSystem::factorize(const Rows& extra, const Rows& free) {
  cholesky_.clear();
  below_.clear();
  for (Eigen::Index block = 0; block < blocks(); ++block) {
    Eigen::MatrixXd schur = diagonal_block(block, extra, free);
    if (block > 0) {
      schur.selfadjointView<Eigen::Lower>().rankUpdate(below_.back(), -1);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(schur);
    if (factor.info() != Eigen::Success) {
      throw std::runtime_error("temporal smoothing: the system is not positive definite");
    }
    cholesky_.push_back(factor.matrixL());
    if (block + 1 == blocks()) break;
    below_.push_back(cholesky_.back()
                         .triangularView<Eigen::Lower>()
                         .solve(lower_block(block, free).transpose())
                         .transpose());
  }
}

TemporalSystem::Rows TemporalSystem::solve(const Rows& right) const {
  Rows x = right;
  const auto part = [&](Eigen::Index block) {
    return Column(x.row(first(block)).data(), size(block) * x.cols());
  };
  for (Eigen::Index block = 0; block < blocks(); ++block) {
    if (block > 0) part(block) -= below_[block - 1] * part(block - 1);
    cholesky_[block].triangularView<Eigen::Lower>().solveInPlace(part(block));
  }
  for (Eigen::Index block = blocks() - 1; block >= 0; --block) {
    if (block + 1 < blocks()) part(block) -= below_[block].transpose() * part(block + 1);
    cholesky_[block].triangularView<Eigen::Lower>().transpose().solveInPlace(part(block));
  }
  return x;
}

}  // namespace mimetra
