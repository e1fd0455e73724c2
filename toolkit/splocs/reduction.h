#pragma once

#include <functional>
#include <vector>

#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/ranks.h"
#include "toolkit/splocs/vertex_part.h"

namespace mimetra {

/// Sums, largest values and copies over all vertices of a mesh: all that the decomposition needs
/// beyond one vertex.
///
/// Each run of vertices (VertexPart) gives a matrix, and the matrices are joined along one binary
/// tree: node i of level l joins the runs from 2^l i up to 2^l (i + 1), or to the last, from its
/// two halves. Nothing else decides in which order numbers are added, so that results are the same
/// bits for every number of threads, and of ranks on processors of one kind: what a run gives is
/// computed by the rank that owns it. Ranks send each other matrices of complete nodes: one each
/// but the first where there are 2, 4, 8 ... of them and 64 runs, some more elsewhere.
///
/// Where a function that is given to one of these calls throws on one rank only (std::bad_alloc, or
/// `compute` of on()), the other ranks wait for it: who stops one must stop all.
class Reduction {
 public:
  /// What one run gives: it writes into a matrix of zeros. `run` is one of part().runs().
  using OfRun = std::function<void(int run, Eigen::MatrixXd& result)>;
  /// Adds what the right half of a node gives to what the left half does.
  using Join = std::function<void(Eigen::MatrixXd& left, const Eigen::MatrixXd& right)>;
  using Compute = std::function<Eigen::MatrixXd()>;

  /// All `vertices` on this rank, or its part of them among `ranks`, which it keeps; `threads` 0
  /// for all there are.
  explicit Reduction(Eigen::Index vertices, int threads = 0, const Ranks* ranks = nullptr);

  const VertexPart& part() const { return part_; }
  int threads() const { return threads_; }
  /// Whether this is the rank that has the results of joined(), sum() and largest().
  bool is_first() const { return part_.rank() == 0; }

  /// What all runs give (rows x columns), joined; on the first rank, 0 x 0 on others. `of_run` and
  /// `join` are called from several threads. Matrices are joined as soon as they can be, so that no
  /// more are held than there are threads and levels of the tree. Throws Cancelled.
  Eigen::MatrixXd joined(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                         const Join& join, const Progress& progress = {}) const;
  /// Joined by adding; on the first rank, 0 x 0 on others.
  Eigen::MatrixXd sum(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                      const Progress& progress = {}) const;
  /// Joined by taking the larger number of two; on the first rank, 0 x 0 on others.
  Eigen::MatrixXd largest(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run) const;

  /// What `compute` gives on one rank, on all of them. Factorizations belong here: ranks on
  /// processors of other kinds need not round alike.
  Eigen::MatrixXd on(int rank, const Compute& compute) const;
  Eigen::MatrixXd on_first(const Compute& compute) const { return on(0, compute); }
  /// What only the first rank has (0 x 0 elsewhere), on all of them.
  Eigen::MatrixXd everywhere(Eigen::MatrixXd of_first) const;

  /// Vertex with the largest of its values, in each of `count` rows: the lowest of those that tie
  /// (kNearTie); -1 where no value is above 0. `values` gives those of an own block, count x n; it
  /// is asked once for each, from several threads. On all ranks.
  std::vector<VertexIndex> argmax(int count,
                                  const std::function<Eigen::MatrixXd(int block)>& values) const;

 private:
  VertexPart part_;
  int threads_;
  const Ranks* ranks_;
};

}  // namespace mimetra
