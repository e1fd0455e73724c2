#include "toolkit/splocs/reduction.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "toolkit/mesh/rounding.h"

namespace mimetra {
VertexPart::VertexPart(Eigen::Index mesh_vertices, int rank, int ranks)
    : mesh_vertices_(mesh_vertices), rank_(rank), ranks_(ranks) {
  if (rank < 0 || rank >= ranks) {
    throw std::invalid_argument("rank " + std::to_string(rank) + " of " + std::to_string(ranks));
  }
  mesh_runs_ = std::min(kMostRuns, mesh_blocks());
  runs_ = dealt_to(rank, ranks, mesh_runs_);
  if (runs_.count() > 0) {
    blocks_ = {mesh_blocks_of(runs_.first).first, mesh_blocks_of(runs_.end - 1).end};
  }
}

Eigen::Index VertexPart::vertices() const {
  return std::min(mesh_vertices_, blocks_.end * kBlock) - first();
}

IndexRange VertexPart::blocks_of(int run) const {
  const IndexRange blocks = mesh_blocks_of(run);
  return {blocks.first - blocks_.first, blocks.end - blocks_.first};
}

int VertexPart::owner(VertexIndex vertex) const {
  const int block = static_cast<int>(vertex / kBlock);
  return owner_of(owner_of(block, mesh_runs_, mesh_blocks()), ranks_, mesh_runs_);
}

int VertexPart::mesh_blocks() const {
  return static_cast<int>((mesh_vertices_ + kBlock - 1) / kBlock);
}

IndexRange VertexPart::mesh_blocks_of(int run) const {
  return dealt_to(run, mesh_runs_, mesh_blocks());
}

std::shared_ptr<const FrameSource> own_vertices(const FrameSource& sequence,
                                                const VertexPart& part) {
  const std::shared_ptr<const FrameSource> whole(std::shared_ptr<const FrameSource>(), &sequence);
  return some_vertices(whole, static_cast<VertexIndex>(part.first()),
                       static_cast<int>(part.vertices()));
}

namespace {

// Values from which argmax() uses all threads; for fewer, starting threads takes longer.
constexpr Eigen::Index kWorthThreads = Eigen::Index{1} << 20;

/// Values of a run's vertices in one row, each larger than all before it. The first vertex with at
/// least a given value is always one of them. Values too small to tie with the largest are dropped.
class Records {
 public:
  /// \pre `value` is positive and larger than all before
  void add(double value, Eigen::Index vertex) {
    // A record that does not tie with a value of its own run cannot tie with the overall largest.
    if (!records_.empty() && records_.back().value < (1 - kNearTie) * value) records_.clear();
    records_.push_back({value, static_cast<double>(vertex)});
  }

  /// First vertex with a value of at least `least`; +infinity if there is none.
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

Reduction::Reduction(Eigen::Index vertices, const Context& context)
    : part_(vertices, context.ranks().rank(), context.ranks().count()),
      context_(context.with_progress({})) {}

Eigen::MatrixXd Reduction::joined(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                                  const Join& join) const {
  return context_.sum(part_.mesh_runs(), rows, columns, of_run, join);
}

Eigen::MatrixXd Reduction::sum(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run) const {
  return context_.sum(part_.mesh_runs(), rows, columns, of_run);
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
  if (part_.ranks() == 1) return result;
  const auto broadcast = [&](Eigen::MatrixXd& matrix) {
    context_.ranks().broadcast(rank, {matrix.data(), static_cast<std::size_t>(matrix.size())});
  };
  Eigen::MatrixXd shape = Eigen::Vector2d(result.rows(), result.cols());
  broadcast(shape);
  result.resize(static_cast<Eigen::Index>(shape(0)), static_cast<Eigen::Index>(shape(1)));
  broadcast(result);
  return result;
}

Eigen::MatrixXd Reduction::everywhere(Eigen::MatrixXd of_first) const {
  return on_first([&of_first] { return std::move(of_first); });
}

std::vector<VertexIndex> Reduction::argmax(
    int count, const std::function<Eigen::MatrixXd(int)>& values) const {
  const auto own = [this](int run) { return run - part_.runs().first; };
  Reduction by_one = *this;
  by_one.context_ = context_.with_threads(1);
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
              // Only positive values count.
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

VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights) {
  return strongest_vertex(energies, weights, Reduction(energies.size()));
}

VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights, const Reduction& reduction) {
  const auto of_block = [&](int b) -> Eigen::MatrixXd {
    const Eigen::Index first = reduction.part().first_of(b), n = reduction.part().size_of(b);
    if (weights.size() == 0) return energies.segment(first, n).transpose();
    return energies.segment(first, n).cwiseProduct(weights.segment(first, n)).transpose();
  };
  return reduction.argmax(1, of_block).front();
}

Eigen::VectorXd vertex_energies(const Eigen::Ref<const Eigen::RowVectorXd>& component) {
  return PositionsView(component.data(), component.size() / 3, 3).rowwise().squaredNorm();
}

}  // namespace mimetra
