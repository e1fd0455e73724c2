#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "toolkit/mesh/note.h"

namespace mimetra {

/// Receives the share of the work that is done, in [0, 1], from time to time. Returning false
/// cancels the computation, which then throws Cancelled.
using Progress = std::function<bool(double)>;

/// Messages between the processes that compute one job together. All processes make the same calls
/// in the same order, each from one thread.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int rank() const = 0;
  virtual int count() const = 0;
  /// Sends numbers to another rank. Messages between two ranks arrive in order, and both sides may
  /// block.
  virtual void send(int to, std::span<const double> numbers) const = 0;
  virtual void receive(int from, std::span<double> numbers) const = 0;
  /// Copies the numbers of rank `from` to all ranks, which must pass the same count.
  virtual void broadcast(int from, std::span<double> numbers) const = 0;
  /// Waits until all ranks have called this function. Polls `goes_on` meanwhile, and throws
  /// Cancelled if it returns false.
  virtual void meet(const std::function<bool()>& goes_on) const = 0;
};

/// Integers first .. end - 1.
struct IndexRange {
  int first = 0;
  int end = 0;

  int count() const { return end - first; }
  bool holds(const IndexRange& other) const { return first <= other.first && other.end <= end; }
};

/// One row of numbers for each frame of a block.
using FrameRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// How a computation runs: its threads, progress and cancellation, the sink of its notes, the
/// processes that share it, and the memory it may use. No result depends on any of these.
///
/// A context is a small value that refers to shared state. It is the last parameter of every
/// function and constructor that takes time:
///
///     const Context context = Context().with_threads(4).with_progress(show);
///     const Analysis analysis = analyse(source, {.count = 30}, context.part(0, 0.7));
///
/// By default, a computation uses all threads of the machine and unlimited memory, reports no
/// progress, and drops its notes.
class Context {
 public:
  Context() = default;

  /// Sets the number of threads; 0 means all threads of the machine.
  Context with_threads(int threads) const;
  /// Reports progress from 0 to 1 to `progress`, from the calling thread.
  Context with_progress(Progress progress) const;
  /// Sends notes to `notes`, from the computing thread.
  Context with_notes(Notes notes) const;
  /// Limits the bytes that a decomposition may take, as planned_decomposition() counts them. No
  /// value means no limit. A negative value means that the process already exceeds its limit.
  Context with_memory(std::optional<double> bytes) const;
  /// \pre the ranks outlive the context and its copies
  Context with_ranks(const Ranks& ranks) const;

  /// Context for the share [from, to] of the progress: report(0) reports `from`, report(1) reports
  /// `to`. A step that needs cancellation but has no share of its own gets part(at, at).
  Context part(double from, double to) const;
  /// Context that drops notes.
  Context quiet() const;
  /// Context for a step that every process does by itself.
  Context without_ranks() const;
  /// Context for work inside a parallel loop: one thread, one process, no progress, no notes.
  Context serial() const;

  int threads() const { return threads_; }
  /// Number of threads, with 0 replaced by the number that the machine has.
  int thread_count() const;
  std::optional<double> memory() const;
  /// Processes that share the computation; this process alone unless with_ranks() set others.
  const Ranks& ranks() const;

  /// Reports a share of the work in [0, 1]. Throws Cancelled.
  void report(double share) const;
  void note(std::string text, Topic topic = Topic::other) const;

  /// Computes the rows (n x columns) of the block that starts with frame `first`.
  using ComputeBlock = std::function<FrameRows(int first, int n)>;
  /// Receives the rows of a block that starts with frame `first`.
  using TakeBlock = std::function<void(int first, const FrameRows& rows)>;
  /// Shares `count` frames among the processes, in blocks of at most `at_once` frames. One process
  /// computes each block, and every process takes it.
  ///
  /// With one process, several threads call both functions, in any order. With several processes,
  /// only the calling thread calls `take`. Each process then holds at most 64 MB of its own blocks,
  /// but between 2 and 32 blocks. Throws whatever the functions throw, and Cancelled. If only one
  /// process throws, the others wait.
  void for_each_block(int count, int at_once, Eigen::Index columns, const ComputeBlock& compute,
                      const TakeBlock& take) const;

  /// Computes the matrix of one run by adding to `result`, which is zero before.
  using OfRun = std::function<void(int run, Eigen::MatrixXd& result)>;
  /// Adds the result of the right half of a node to that of its left half.
  using Join = std::function<void(Eigen::MatrixXd& left, const Eigen::MatrixXd& right)>;
  /// Joins the matrices (rows x columns) of all runs along one binary tree. Node i of level l joins
  /// runs 2^l i up to 2^l (i + 1), or to the last. Only the tree decides the order of additions.
  /// The result therefore has the same bits for any number of threads, and for any number of
  /// processes on processors of one kind.
  ///
  /// Each process calls `of_run` for the runs that dealt_to() gives it. Several threads call both
  /// functions. A process holds about one matrix per thread and one per level of the tree.
  ///
  /// Returns the result on the first process and 0 x 0 on the others. Throws Cancelled. If a
  /// function throws on only one process, the others wait for it.
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

/// Things that belong to one of several owners when `things` are dealt out in order.
IndexRange dealt_to(int owner, int owners, int things);
/// Owner of one thing, by the rule of dealt_to().
int owner_of(int thing, int owners, int things);

}  // namespace mimetra
