#include "tests/bench/machine.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <thread>
#include <vector>

#include <Eigen/Core>

namespace mimetra::bench {
namespace {

/// Seconds that `work(thread)` takes on all threads together.
template <typename Function>
double seconds_on(int threads, const Function& work) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::jthread> others;
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(work, thread);
  work(0);
  others.clear();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Each thread's best, together: a round is shorter than what the scheduler gives to others.
double product_rate(int threads, int rounds) {
  constexpr int kSide = 384;
  constexpr double kFlops = 2.0 * kSide * kSide * kSide;
  std::vector<double> best(static_cast<std::size_t>(threads));
  seconds_on(threads, [&](int thread) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(kSide, kSide);
    const Eigen::MatrixXd B = Eigen::MatrixXd::Random(kSide, kSide);
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(kSide, kSide);
    for (int round = 0; round < rounds; ++round) {
      const double seconds = seconds_on(1, [&](int) { C.noalias() = A * B; });
      double& own = best[static_cast<std::size_t>(thread)];
      own = std::max(own, kFlops / seconds);
    }
  });
  return std::accumulate(best.begin(), best.end(), 0.0);
}

double read_rate(const Machine& machine, int rounds) {
  constexpr double kFarLarger = 16, kMost = 1 << 30;
  const double bytes = std::min(kFarLarger * machine.cache_bytes, kMost);
  const auto size = static_cast<Eigen::Index>(bytes / sizeof(double));
  const Eigen::VectorXd block = Eigen::VectorXd::Ones(size);
  const Eigen::Index part = size / machine.threads;
  std::vector<double> sums(static_cast<std::size_t>(machine.threads)), rates;
  for (int round = 0; round < rounds; ++round) {
    const double seconds = seconds_on(machine.threads, [&](int thread) {
      sums[static_cast<std::size_t>(thread)] = block.segment(thread * part, part).sum();
    });
    // The sums are used, or the compiler would leave them out.
    if (sums.front() == static_cast<double>(part)) {
      rates.push_back(static_cast<double>(part * machine.threads) * sizeof(double) / seconds);
    }
  }
  return *std::ranges::max_element(rates);
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

/// The C library's own number counts some processors' caches once for each core of the socket.
double cache_size() {
  constexpr double kAssumed = 32 << 20;
  std::ifstream file("/sys/devices/system/cpu/cpu0/cache/index3/size");
  double kibibytes = 0;
  return file >> kibibytes ? 1024 * kibibytes : kAssumed;
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.processor = processor_name();
  machine.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  machine.cache_bytes = cache_size();
  if (getloadavg(&machine.load, 1) != 1) machine.load = 0;
  return machine;
}

Limits measured_limits(const Machine& machine, bool quick) {
  const int rounds = quick ? 5 : 25;
  constexpr int kShortRounds = 20;  // products in the time of one pass over the block
  return {product_rate(machine.threads, kShortRounds * rounds), read_rate(machine, rounds)};
}

Limits best_of(const Limits& a, const Limits& b) {
  return {std::max(a.flops, b.flops), std::max(a.bytes, b.bytes)};
}

Work both(const Work& a, const Work& b) {
  return {a.flops + b.flops, a.bytes + b.bytes};
}

double floor_seconds(const Work& work, const Limits& limits) {
  return std::max(work.flops / limits.flops, work.bytes / limits.bytes);
}

double passes(double block_bytes, double times, const Machine& machine) {
  return block_bytes > machine.cache_bytes ? times * block_bytes : block_bytes;
}

}  // namespace mimetra::bench
