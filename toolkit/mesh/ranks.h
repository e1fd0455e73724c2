#pragma once

#include <functional>
#include <span>

namespace mimetra {

/// How several processes that work on one job talk to each other. All make the same calls in the
/// same order, each from one thread.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int rank() const = 0;
  virtual int count() const = 0;
  /// What one rank sends to another arrives there in order; both may wait for each other.
  virtual void send(int to, std::span<const double> numbers) const = 0;
  virtual void receive(int from, std::span<double> numbers) const = 0;
  /// Gives the numbers of rank `from` to all, which all call it with as many.
  virtual void broadcast(int from, std::span<double> numbers) const = 0;
  /// Waits until all have called it. Throws Cancelled where `goes_on`, asked meanwhile, is false.
  virtual void meet(const std::function<bool()>& goes_on) const = 0;
};

}  // namespace mimetra
