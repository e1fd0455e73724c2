#pragma once

#include <latch>
#include <thread>
#include <vector>

#include "tests/shapes.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra::test {

/// More than any machine of ours has to itself.
constexpr int kTogether = 4;

/// Calls `work(i)` in kTogether threads, which begin at once.
template <typename Work>
void together(const Work& work) {
  std::latch start(kTogether);
  std::vector<std::jthread> threads;
  threads.reserve(kTogether);
  for (int i = 0; i < kTogether; ++i) {
    threads.emplace_back([&work, &start, i] {
      start.arrive_and_wait();
      work(i);
    });
  }
}

/// A sphere of which two places bulge, one after the other.
inline MeshSequence bulging_sphere(int frames) {
  const Shape shape = sphere(2);
  Frames poses(frames, shape.positions.size());
  for (int f = 0; f < frames; ++f) {
    Positions pose = shape.positions;
    for (Eigen::Index v = 0; v < pose.rows(); ++v) {
      const double phase = std::numbers::pi * f / frames;
      const double up = std::max(0.0, pose(v, 2) - 0.5) * std::pow(std::sin(phase), 2);
      const double aside = std::max(0.0, pose(v, 0) - 0.5) * std::pow(std::cos(phase), 2);
      pose.row(v) *= 1 + up + aside;
    }
    poses.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return {mesh_of(shape).connectivity, std::move(poses),
          Eigen::VectorXd::LinSpaced(frames, 0, frames - 1) / 25, shape.positions};
}

}  // namespace mimetra::test
