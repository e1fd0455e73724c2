#pragma once

#include <functional>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/splocs/vertex_part.h"

namespace mimetra {

/// Sums, largest values and copies over all vertices of a mesh: all that the decomposition needs
/// beyond one vertex.
///
/// Each run of vertices (VertexPart) gives a matrix, which the rank that owns the run computes.
/// Context::sum() joins the matrices, so results have the same bits for any number of threads, and
/// of ranks on processors of one kind. Ranks send each other matrices of complete nodes: each rank
/// but the first sends one if there are 2, 4, 8 ... ranks and 64 runs, otherwise some more.
///
/// If a function that is given to one of these calls throws on one rank only (std::bad_alloc, or
/// `compute` of on()), the other ranks wait for it: a caller that stops one must stop all.
class Reduction {
 public:
  using OfRun = Context::OfRun;
  using Join = Context::Join;
  using Compute = std::function<Eigen::MatrixXd()>;

  /// This rank's part of the `vertices` of a mesh. Keeps the context but for its progress, since
  /// one step of a computation may take many of these calls.
  explicit Reduction(Eigen::Index vertices, const Context& context = {});

  const VertexPart& part() const { return part_; }
  const Context& context() const { return context_; }
  /// Whether this is the rank that has the results of joined(), sum() and largest().
  bool is_first() const { return part_.rank() == 0; }

  /// Context::sum() over all runs of the mesh: `of_run` is called for each of part().runs().
  Eigen::MatrixXd joined(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                         const Join& join) const;
  Eigen::MatrixXd sum(Eigen::Index rows, Eigen::Index columns, const OfRun& of_run) const;
  /// joined() by taking the larger number of two.
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
  Context context_;
};

}  // namespace mimetra
