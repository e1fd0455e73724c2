#include <algorithm>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

std::span<double> numbers_of(Eigen::MatrixXd& matrix) {
  return {matrix.data(), static_cast<std::size_t>(matrix.size())};
}

/// Number of blocks, each of `numbers` numbers, that a process computes before they are shared.
int dealt_blocks(Eigen::Index numbers) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  const std::size_t block =
      sizeof(double) * static_cast<std::size_t>(std::max<Eigen::Index>(1, numbers));
  return static_cast<int>(std::clamp<std::size_t>(kBytes / block, 2, 32));
}

/// Binary tree over all runs, including those of other processes.
class RunTree {
 public:
  RunTree(int runs, const Ranks& ranks, const Context::Join& join)
      : ranks_(ranks),
        own_(dealt_to(ranks.rank(), ranks.count(), runs)),
        join_(join),
        results_(runs),
        complete_(runs, 0) {}

  const IndexRange& own() const { return own_; }

  /// Adds the result of one of this process's runs. Joins it upwards until the other half is
  /// missing or belongs to another process. Several threads may call it.
  void add(int run, Eigen::MatrixXd result) {
    std::unique_lock lock(mutex_);
    results_[run] = std::move(result);
    for (int half = 1; half < runs(); half *= 2) {
      complete_[run] = half;
      const int left = run / (2 * half) * (2 * half), right = left + half;
      if (right >= runs()) continue;
      if (!is_own(left, half) || complete_[run == left ? right : left] != half) return;
      // The thread that completes the second half joins both; no other thread uses them.
      lock.unlock();
      join_own(left, right);
      lock.lock();
      run = left;
    }
  }

  /// Joins nodes whose halves belong to several processes. All processes visit them in the same
  /// order, so two that wait for each other are always at the same node.
  void join_processes() {
    for (int half = 1; half < runs(); half *= 2) {
      for (int left = 0; left + half < runs(); left += 2 * half) {
        if (!is_own(left, half)) join_processes(left, left + half);
      }
    }
  }

  Eigen::MatrixXd root() && { return std::move(results_.front()); }

 private:
  int runs() const { return static_cast<int>(results_.size()); }
  int owner(int run) const { return owner_of(run, ranks_.count(), runs()); }

  /// Whether this process computes all runs of a node.
  bool is_own(int left, int half) const {
    return own_.holds({left, std::min(left + 2 * half, runs())});
  }

  void join_own(int left, int right) {
    join_(results_[left], results_[right]);
    results_[right].resize(0, 0);
  }

  /// Joins two halves of a node. The node belongs to the process that has its first run.
  void join_processes(int left, int right) {
    const bool has_left = owner(left) == ranks_.rank(), has_right = owner(right) == ranks_.rank();
    if (has_left && !has_right) {
      results_[right].resizeLike(results_[left]);
      ranks_.receive(owner(right), numbers_of(results_[right]));
    }
    if (has_left) {
      join_own(left, right);
    } else if (has_right) {
      ranks_.send(owner(left), numbers_of(results_[right]));
      results_[right].resize(0, 0);
    }
  }

  const Ranks& ranks_;
  IndexRange own_;
  const Context::Join& join_;
  std::vector<Eigen::MatrixXd> results_;
  /// Number of runs in the largest complete half that begins at each run.
  std::vector<int> complete_;
  std::mutex mutex_;
};

}  // namespace

void Context::for_each_block(int count, int at_once, Eigen::Index columns,
                             const ComputeBlock& compute, const TakeBlock& take) const {
  const int blocks = (count + at_once - 1) / at_once;
  const auto length = [&](int block) { return std::min(at_once, count - block * at_once); };
  const auto computed = [&](int block) { return compute(block * at_once, length(block)); };
  const int rank = ranks().rank(), processes = ranks().count();
  if (processes == 1) {
    const auto work = [&](int block) { take(block * at_once, computed(block)); };
    return parallel_for(blocks, work, *this);
  }
  const int together = dealt_blocks(at_once * columns) * processes;
  for (int start = 0; start < blocks; start += together) {
    report(static_cast<double>(start) / blocks);
    const int end = std::min(blocks, start + together);
    std::vector<FrameRows> own(std::max(0, (end - start - rank + processes - 1) / processes));
    parallel_for(
        static_cast<int>(own.size()),
        [&](int i) { own[i] = computed(start + rank + i * processes); },
        Context().with_threads(threads_));
    for (int block = start; block < end; ++block) {
      const int owner = (block - start) % processes;
      FrameRows rows = owner == rank ? std::move(own[(block - start) / processes])
                                     : FrameRows(length(block), columns);
      ranks().broadcast(owner, {rows.data(), static_cast<std::size_t>(rows.size())});
      take(block * at_once, rows);
    }
  }
  report(1);
}

Eigen::MatrixXd Context::sum(int runs, Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                             const Join& join) const {
  if (runs == 0) return Eigen::MatrixXd::Zero(rows, columns);
  RunTree tree(runs, ranks(), join);
  const auto add_run = [&](int i) {
    const int run = tree.own().first + i;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, columns);
    of_run(run, result);
    tree.add(run, std::move(result));
  };
  parallel_for(tree.own().count(), add_run, *this);
  tree.join_processes();
  return ranks().rank() == 0 ? std::move(tree).root() : Eigen::MatrixXd();
}

Eigen::MatrixXd Context::sum(int runs, Eigen::Index rows, Eigen::Index columns,
                             const OfRun& of_run) const {
  return sum(runs, rows, columns, of_run,
             [](Eigen::MatrixXd& left, const Eigen::MatrixXd& right) { left += right; });
}

}  // namespace mimetra
