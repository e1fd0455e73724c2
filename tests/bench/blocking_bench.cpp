#include "tests/bench/blocking_bench.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

#include <Eigen/Core>

#include "tests/bench/splocs_bench.h"
#include "tests/bench/transfer_bench.h"
#include "toolkit/mesh/rounding.h"

namespace mimetra::bench {
namespace {

/// The fourth smallest and the fourth largest of so many ratios hold the median with 96 %.
constexpr std::size_t kPairs = 15, kFourth = 3;

constexpr double kShortest = 0.05;  // seconds of one time

/// As if mimetra left Eigen alone.
void use_own_caches() {
  int first = 0, second = 0, third = 0;
  Eigen::internal::queryCacheSizes(first, second, third);
  Eigen::setCpuCacheSizes(first, second, third);
}

double seconds(const std::function<void()>& run, int times) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < times; ++i) run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Comparison compared_pairs(const Case& kernel) {
  kernel.run();
  const int times = std::max(1, static_cast<int>(kShortest / seconds(kernel.run, 1)));
  std::array<double, kPairs> ratios{};
  for (std::size_t pair = 0; pair < kPairs; ++pair) {
    // Each comes first as often as the other, but for one.
    double fixed = 0, own = 0;
    for (const bool is_fixed : {pair % 2 == 0, pair % 2 == 1}) {
      is_fixed ? fix_product_blocking() : use_own_caches();
      (is_fixed ? fixed : own) = seconds(kernel.run, times);
    }
    ratios[pair] = fixed / own;
  }
  fix_product_blocking();
  std::ranges::sort(ratios);
  std::array<char, 100> numbers{};
  std::snprintf(numbers.data(), numbers.size(), ": %.3f (%.3f to %.3f) times as long",
                ratios[kPairs / 2], ratios[kFourth], ratios[kPairs - 1 - kFourth]);
  return {"blocks for every processor against this one's, " + kernel.row.what + ", " +
              kernel.row.size.text() + numbers.data(),
          ratios[kPairs / 2]};
}

}  // namespace

std::vector<Comparison> blocking_comparisons(const Subject& subject, int count,
                                             const Settings& settings) {
  std::vector<Case> kernels =
      splocs_kernel_cases(subject.name, subject.performance, count, settings);
  std::ranges::move(right_hand_side_cases(subject), std::back_inserter(kernels));
  const Eigen::Index expressions = subject.target.expressions().size();
  const auto rows = std::make_shared<Eigen::MatrixXd>(
      Eigen::MatrixXd::Random(6 * subject.target.triangles().rows(), expressions));
  const Size size{subject.name, 0, subject.performance.vertices(), "D",
                  static_cast<int>(expressions)};
  kernels.push_back({{"", "A^T A of eq. 11 in one product", size, {}}, [rows, expressions] {
                       Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(expressions, expressions);
                       gram.selfadjointView<Eigen::Lower>().rankUpdate(rows->transpose());
                     }});
  std::vector<Comparison> comparisons;
  for (const Case& kernel : kernels) comparisons.push_back(compared_pairs(kernel));
  return comparisons;
}

}  // namespace mimetra::bench
