#pragma once

#include "toolkit/mesh/context.h"

namespace mimetra::cli {

/// The processes that mpirun started, as ranks. Create one object on one thread and keep it as long
/// as the program runs.
class MpiRanks : public Ranks {
 public:
  MpiRanks();
  /// Waits for the other processes.
  ~MpiRanks() override;
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  void send(int to, std::span<const double> numbers) const override;
  void receive(int from, std::span<double> numbers) const override;
  void broadcast(int from, std::span<double> numbers) const override;
  void meet(const std::function<bool()>& goes_on) const override;

  /// Number of processes on this machine, including this one.
  int on_this_machine() const;

  /// Ends all processes; mpirun returns `code`.
  [[noreturn]] void end_all(int code) const;

 private:
  int rank_ = 0;
  int count_ = 1;
};

}  // namespace mimetra::cli
