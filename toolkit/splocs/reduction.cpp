#include "toolkit/splocs/reduction.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <utility>

#include "toolkit/mesh/near_tie.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

// Values among which argmax() looks with all threads: for fewer, starting these takes longer.
constexpr Eigen::Index kWorthThreads = Eigen::Index{1} << 20;

std::span<double> numbers_of(Eigen::MatrixXd& matrix) {
  return {matrix.data(), static_cast<std::size_t>(matrix.size())};
}

/// The tree over all runs, of which one rank computes some.
class RunTree {
 public:
  RunTree(const VertexPart& part, const Reduction::Join& join)
      : part_(part), join_(join), results_(part.mesh_runs()), complete_(part.mesh_runs(), 0) {}

  /// Takes what an own run gives, and joins it upwards as far as the other halves are there and
  /// no other rank takes part. From several threads.
  void add(int run, Eigen::MatrixXd result) {
    std::unique_lock lock(mutex_);
    results_[run] = std::move(result);
    for (int half = 1; half < runs(); half *= 2) {
      complete_[run] = half;
      const int left = run / (2 * half) * (2 * half), right = left + half;
      if (right >= runs()) continue;
      if (!is_own(left, half) || complete_[run == left ? right : left] != half) return;
      // Whoever completes a half last joins it: nobody else touches the two.
      lock.unlock();
      join_own(left, right);
      lock.lock();
      run = left;
    }
  }

  /// Joins what takes several ranks. Each walks through the nodes in the same order, so that two
  /// that wait for each other are always at the same node.
  void join_ranks(const Ranks& ranks) {
    for (int half = 1; half < runs(); half *= 2) {
      for (int left = 0; left + half < runs(); left += 2 * half) {
        if (!is_own(left, half)) join_ranks(ranks, left, left + half);
      }
    }
  }

  Eigen::MatrixXd root() && { return std::move(results_.front()); }

 private:
  int runs() const { return part_.mesh_runs(); }

  /// Whether all runs of a node are this rank's.
  bool is_own(int left, int half) const {
    return part_.runs().holds({left, std::min(left + 2 * half, runs())});
  }

  void join_own(int left, int right) {
    join_(results_[left], results_[right]);
    results_[right].resize(0, 0);
  }

  /// A node belongs to the rank that owns its first run.
  void join_ranks(const Ranks& ranks, int left, int right) {
    const int of_left = part_.owner_of_run(left), of_right = part_.owner_of_run(right);
    const bool has_left = of_left == part_.rank(), has_right = of_right == part_.rank();
    if (has_left && !has_right) {
      results_[right].resizeLike(results_[left]);
      ranks.receive(of_right, numbers_of(results_[right]));
    }
    if (has_left) {
      join_own(left, right);
    } else if (has_right) {
      ranks.send(of_left, numbers_of(results_[right]));
      results_[right].resize(0, 0);
    }
  }

  const VertexPart& part_;
  const Reduction::Join& join_;
  std::vector<Eigen::MatrixXd> results_;
  /// Runs in the largest half that is complete, for each run that begins one.
  std::vector<int> complete_;
  std::mutex mutex_;
};

/// Values of a run's vertices in one row, each larger than all before it: the first vertex with at
/// least some value is always one of them. Those too small to tie with the largest are left out.
class Records {
 public:
  /// \pre `value` is above 0 and all before it
  void add(double value, Eigen::Index vertex) {
    // What is no tie with a value of its own run will be none with the largest of all.
    if (!records_.empty() && records_.back().value < (1 - kNearTie) * value) records_.clear();
    records_.push_back({value, static_cast<double>(vertex)});
  }

  /// First vertex with a value of at least so much; +infinity where there is none.
  double first_from(double least) const {
    const auto found = std::ranges::find_if(
        records_, [least](const Record& record) { return record.value >= least; });
    return found == records_.end() ? std::numeric_limits<double>::infinity() : found->vertex;
  }

 private:
  struct Record {
    double value, vertex;
  };
  std::vector<Record> records_;
};

}  // namespace

Reduction::Reduction(Eigen::Index vertices, int threads, const Ranks* ranks)
    : part_(vertices, ranks ? ranks->rank() : 0, ranks ? ranks->count() : 1),
      threads_(threads),
      ranks_(ranks) {}

Eigen::MatrixXd Reduction::joined(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                                  const Join& join, const Progress& progress) const {
  if (part_.mesh_runs() == 0) return Eigen::MatrixXd::Zero(rows, columns);
  RunTree tree(part_, join);
  const auto add_run = [&](int i) {
    const int run = part_.runs().first + i;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, columns);
    of_run(run, result);
    tree.add(run, std::move(result));
  };
  parallel_for(part_.runs().count(), threads_, add_run, progress);
  if (ranks_) tree.join_ranks(*ranks_);
  return is_first() ? std::move(tree).root() : Eigen::MatrixXd();
}

Eigen::MatrixXd Reduction::sum(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                               const Progress& progress) const {
  return joined(
      rows, columns, of_run,
      [](Eigen::MatrixXd& left, const Eigen::MatrixXd& right) { left += right; }, progress);
}

Eigen::MatrixXd Reduction::largest(Eigen::Index rows, Eigen::Index columns,
                                   const OfRun& of_run) const {
  return joined(rows, columns, of_run, [](Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
    left = left.cwiseMax(right);
  });
}

Eigen::MatrixXd Reduction::on(int rank, const Compute& compute) const {
  Eigen::MatrixXd result;
  if (rank == part_.rank()) result = compute();
  if (!ranks_) return result;
  Eigen::MatrixXd shape = Eigen::Vector2d(result.rows(), result.cols());
  ranks_->broadcast(rank, numbers_of(shape));
  result.resize(static_cast<Eigen::Index>(shape(0)), static_cast<Eigen::Index>(shape(1)));
  ranks_->broadcast(rank, numbers_of(result));
  return result;
}

Eigen::MatrixXd Reduction::everywhere(Eigen::MatrixXd of_first) const {
  return on_first([&of_first] { return std::move(of_first); });
}

std::vector<VertexIndex> Reduction::argmax(
    int count, const std::function<Eigen::MatrixXd(int)>& values) const {
  const auto own = [this](int run) { return run - part_.runs().first; };
  Reduction by_one = *this;
  by_one.threads_ = 1;
  const Reduction& by_threads = count * part_.vertices() < kWorthThreads ? by_one : *this;
  std::vector<std::vector<Records>> records(part_.runs().count(), std::vector<Records>(count));
  const Eigen::VectorXd largest =
      everywhere(by_threads.largest(count, 1, [&](int run, Eigen::MatrixXd& largest_of_run) {
        const IndexRange blocks = part_.blocks_of(run);
        for (int b = blocks.first; b < blocks.end; ++b) {
          const Eigen::MatrixXd of_block = values(b);
          const Eigen::Index first = part_.first() + part_.first_of(b);
          for (Eigen::Index v = 0; v < of_block.cols(); ++v) {
            for (int k = 0; k < count; ++k) {
              // Other values than positive ones do not count.
              if (!(of_block(k, v) > largest_of_run(k))) continue;
              largest_of_run(k) = of_block(k, v);
              records[own(run)][k].add(of_block(k, v), first + v);
            }
          }
        }
      }));
  const Eigen::VectorXd as_large = (1 - kNearTie) * largest;
  const Eigen::VectorXd lowest = everywhere(by_one.joined(
      count, 1,
      [&](int run, Eigen::MatrixXd& lowest_of_run) {
        for (int k = 0; k < count; ++k) {
          lowest_of_run(k) = records[own(run)][k].first_from(as_large[k]);
        }
      },
      [](Eigen::MatrixXd& left, const Eigen::MatrixXd& right) { left = left.cwiseMin(right); }));
  std::vector<VertexIndex> result(count, -1);
  for (int k = 0; k < count; ++k) {
    if (largest[k] > 0) result[k] = static_cast<VertexIndex>(lowest[k]);
  }
  return result;
}

}  // namespace mimetra
