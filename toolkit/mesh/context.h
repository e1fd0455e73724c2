#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "toolkit/mesh/note.h"

namespace mimetra {

/// Receives the share of the work that is done, in [0, 1], now and then. Returning false cancels
/// the computation, which then throws Cancelled.
using Progress = std::function<bool(double)>;

/// Messages between the processes that compute one job together. All processes make the same calls
/// in the same order, each from one thread.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int rank() const = 0;
  virtual int count() const = 0;
  /// Numbers that one rank sends to another arrive in order; both may wait for each other.
  virtual void send(int to, std::span<const double> numbers) const = 0;
  virtual void receive(int from, std::span<double> numbers) const = 0;
  /// Copies the numbers of rank `from` to all ranks, which all pass as many.
  virtual void broadcast(int from, std::span<double> numbers) const = 0;
  /// Waits until all ranks have called it. Throws Cancelled when `goes_on`, asked meanwhile,
  /// returns false.
  virtual void meet(const std::function<bool()>& goes_on) const = 0;
};

/// The numbers first .. end - 1.
struct IndexRange {
  int first = 0;
  int end = 0;

  int count() const { return end - first; }
  bool holds(const IndexRange& other) const { return first <= other.first && other.end <= end; }
};

/// One row of numbers for each frame of a block.
using FrameRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// How a computation runs: its threads, its progress and cancellation, the sink of its notes, the
/// processes that share it and the memory that it may take. No result depends on any of them.
///
/// A small value that refers to shared state. It is the last parameter of every function that takes
/// time, also of constructors:
///
///     const Context context = Context().with_threads(4).with_progress(show);
///     const Analysis analysis = analyse(source, {.count = 30}, context.part(0, 0.7));
///
/// By default a computation takes all threads of the machine and as much memory as it likes, tells
/// nobody of its progress, and drops its notes.
class Context {
 public:
  Context() = default;

  /// Number of threads, 0 for all that the machine has.
  Context with_threads(int threads) const;
  /// From now on `progress` receives 0 to 1. The calling thread calls it.
  Context with_progress(Progress progress) const;
  /// The thread that computes calls `notes`.
  Context with_notes(Notes notes) const;
  /// Bytes that a decomposition may take, as planned_decomposition() counts them; none for as many
  /// as it likes. A negative number means that the process has taken more already.
  Context with_memory(std::optional<double> bytes) const;
  /// \pre the ranks outlive the context and its copies
  Context with_ranks(const Ranks& ranks) const;

  /// The share [from, to] of the progress: report(0) reports `from`, report(1) reports `to`. A step
  /// without a share of its own, which still can be cancelled, gets part(at, at).
  Context part(double from, double to) const;
  /// Drops notes.
  Context quiet() const;
  /// For a step that every process does by itself.
  Context without_ranks() const;
  /// For work inside of a parallel loop: one thread, one process, no progress, no notes.
  Context serial() const;

  int threads() const { return threads_; }
  /// The same, or as many as the machine has where that is 0.
  int thread_count() const;
  std::optional<double> memory() const;
  /// The processes that share the computation; this one alone unless with_ranks() named others.
  const Ranks& ranks() const;

  /// Reports a share of the work in [0, 1]. Throws Cancelled.
  void report(double share) const;
  void note(std::string text, Topic topic = Topic::other) const;

  /// Computes the rows (n x columns) of blocks of at most `at_once` of `count` frames.
  using ComputeBlock = std::function<FrameRows(int first, int n)>;
  /// Receives the rows of a block that starts with frame `first`.
  using TakeBlock = std::function<void(int first, const FrameRows& rows)>;
  /// Shares frames among the processes, a block at a time: one process computes each block and all
  /// take it. Several threads call both functions, in any order; on several processes only the
  /// calling thread calls `take`, and a process holds no more of its blocks than fill 64 MB, or
  /// two. Throws what they throw, and Cancelled. If one process alone throws, the others wait.
  void for_each_block(int count, int at_once, Eigen::Index columns, const ComputeBlock& compute,
                      const TakeBlock& take) const;

  /// Computes the matrix of one run: it adds to a matrix of zeros.
  using OfRun = std::function<void(int run, Eigen::MatrixXd& result)>;
  /// Adds the result of the right half of a node to that of its left half.
  using Join = std::function<void(Eigen::MatrixXd& left, const Eigen::MatrixXd& right)>;
  /// Adds, or joins otherwise, the matrices (rows x columns) of all runs along one binary tree:
  /// node i of level l joins the runs from 2^l i up to 2^l (i + 1), or to the last. Nothing else
  /// decides the order of additions, so the result has the same bits for any number of threads, and
  /// of processes on processors of one kind. `of_run` is called for the runs that are dealt() to
  /// this process. Both functions are called from several threads. No more matrices are held than
  /// there are threads and levels of the tree.
  ///
  /// Returns the result on the first process and 0 x 0 on the others. Throws Cancelled. If a
  /// function throws on one process only, the others wait for it.
  Eigen::MatrixXd sum(int runs, Eigen::Index rows, Eigen::Index columns, const OfRun& of_run,
                      const Join& join) const;
  Eigen::MatrixXd sum(int runs, Eigen::Index rows, Eigen::Index columns, const OfRun& of_run) const;

 private:
  struct Shared;

  Context changed(const std::function<void(Shared&)>& change) const;

  int threads_ = 0;
  double from_ = 0;
  double to_ = 1;
  bool is_quiet_ = false;
  std::shared_ptr<const Shared> shared_;
};

/// The things that fall to one of several owners when `things` are dealt out in order.
IndexRange dealt_to(int owner, int owners, int things);
/// The owner of one of them.
int owner_of(int thing, int owners, int things);

}  // namespace mimetra
