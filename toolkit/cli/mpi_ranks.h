#pragma once

#include "toolkit/mesh/context.h"

namespace mimetra::cli {

/// The processes that mpirun started, as ranks. There is one of it, for as long as the program
/// runs, on the thread that makes it.
class MpiRanks : public Ranks {
 public:
  MpiRanks();
  /// Waits for the others.
  ~MpiRanks() override;
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  void send(int to, std::span<const double> numbers) const override;
  void receive(int from, std::span<double> numbers) const override;
  void broadcast(int from, std::span<double> numbers) const override;
  void meet(const std::function<bool()>& goes_on) const override;

  /// How many of the processes share this one's machine, with itself.
  int on_this_machine() const;

  /// Ends all processes; mpirun returns `code`.
  [[noreturn]] void end_all(int code) const;

 private:
  int rank_ = 0;
  int count_ = 1;
};

}  // namespace mimetra::cli
