#pragma once

#include <array>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

/// What a program, or a processor, may have set in Eigen before mimetra computes.
namespace mimetra::test {

/// Sizes of the three levels in bytes.
using CacheSizes = std::array<std::ptrdiff_t, 3>;

/// Inner dimensions above 120, 376 and 1016 are cut.
constexpr std::array<CacheSizes, 3> kProcessors = {
    {{16 << 10, 128 << 10, 1 << 20}, {48 << 10, 2 << 20, 32 << 20}, {128 << 10, 4 << 20, 8 << 20}}};

inline bool equal_bytes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// What `compute` gives after each of kProcessors was set, as matrices.
template <typename Compute>
std::vector<Eigen::MatrixXd> for_each_processor(const Compute& compute) {
  std::vector<Eigen::MatrixXd> results;
  for (const CacheSizes& sizes : kProcessors) {
    Eigen::setCpuCacheSizes(sizes[0], sizes[1], sizes[2]);
    results.emplace_back(compute());
  }
  return results;
}

template <typename Compute>
void expect_equal_bytes_on_each_processor(const Compute& compute) {
  const std::vector<Eigen::MatrixXd> results = for_each_processor(compute);
  ASSERT_GT(results.front().size(), 0);
  for (std::size_t i = 1; i < results.size(); ++i) {
    EXPECT_TRUE(equal_bytes(results[i], results.front())) << "caches " << i;
  }
}

}  // namespace mimetra::test
