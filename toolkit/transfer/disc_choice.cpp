#include "toolkit/transfer/disc_choice.h"

#include <utility>

#include <Eigen/Cholesky>

#include "toolkit/mesh/product_blocking.h"

namespace mimetra {

Sight Sight::none(Eigen::Index expressions, Eigen::Index frames) {
  return {Eigen::MatrixXd::Zero(expressions, expressions),
          Eigen::MatrixXd::Zero(expressions, frames)};
}

Sight& Sight::operator+=(const Sight& more) {
  gram += more.gram;
  pull += more.pull;
  return *this;
}

DiscChoice::DiscChoice(Eigen::MatrixXd gram, double variance, double noise)
    : gram_(std::move(gram)),
      ridge_(kRidge * gram_.diagonal().mean()),
      variance_(noise * variance) {}

double DiscChoice::criterion(const Sight& of_regions) const {
  fix_product_blocking();
  Eigen::MatrixXd system = of_regions.gram;
  system.diagonal().array() += ridge_;
  const Eigen::LLT<Eigen::MatrixXd> factor(system);
  const Eigen::MatrixXd shift = factor.solve(of_regions.pull);
  const double bias = shift.cwiseProduct(gram_ * shift).sum();
  return bias / static_cast<double>(shift.cols()) + variance_ * factor.solve(gram_).trace();
}

}  // namespace mimetra
