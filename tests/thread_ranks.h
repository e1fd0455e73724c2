#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "toolkit/mesh/context.h"

/// Ranks that are threads of one process: each works on what it was given alone, and knows of the
/// others only what comes through Ranks.
namespace mimetra::test {

/// What ranks sent to each other.
struct Traffic {
  int messages = 0;
  std::size_t numbers = 0;
};

/// What is on its way between ranks.
class Mail {
 public:
  /// Waits until the receiver has taken it, as the strictest of networks does.
  void send(int from, int to, std::span<const double> numbers) {
    std::unique_lock lock(mutex_);
    std::deque<std::vector<double>>& queue = queues_[{from, to}];
    queue.emplace_back(numbers.begin(), numbers.end());
    ++traffic_.messages;
    traffic_.numbers += numbers.size();
    changed_.notify_all();
    wait(lock, [&queue] { return queue.empty(); });
  }

  void receive(int from, int to, std::span<double> numbers) {
    std::unique_lock lock(mutex_);
    std::deque<std::vector<double>>& queue = queues_[{from, to}];
    wait(lock, [&queue] { return !queue.empty(); });
    if (queue.front().size() != numbers.size()) {
      throw std::logic_error(std::to_string(queue.front().size()) + " numbers were sent, " +
                             std::to_string(numbers.size()) + " expected");
    }
    std::ranges::copy(queue.front(), numbers.begin());
    queue.pop_front();
    changed_.notify_all();
  }

  const Traffic& traffic() const { return traffic_; }

 private:
  /// Throws where nobody comes: a test that waits for ever tells nothing.
  void wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_over) {
    if (!changed_.wait_for(lock, std::chrono::seconds(60), is_over)) {
      throw std::logic_error("a rank waited in vain for another");
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::pair<int, int>, std::deque<std::vector<double>>> queues_;
  Traffic traffic_;
};

class ThreadRank : public Ranks {
 public:
  ThreadRank(Mail& mail, int rank, int count) : mail_(mail), rank_(rank), count_(count) {}

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  void send(int to, std::span<const double> numbers) const override {
    mail_.send(rank_, to, numbers);
  }
  void receive(int from, std::span<double> numbers) const override {
    mail_.receive(from, rank_, numbers);
  }
  void broadcast(int from, std::span<double> numbers) const override {
    if (rank_ != from) return receive(from, numbers);
    for (int to = 0; to < count_; ++to) {
      if (to != rank_) send(to, numbers);
    }
  }
  void meet(const std::function<bool()>& /*goes_on*/) const override {
    for (int rank = 0; rank < count_; ++rank) broadcast(rank, {});
  }

 private:
  Mail& mail_;
  int rank_, count_;
};

/// Calls `work` for each of so many ranks at a time; returns what they sent. Throws what the
/// lowest rank threw.
inline Traffic on_ranks(int count, const std::function<void(const Ranks&)>& work) {
  Mail mail;
  std::vector<std::exception_ptr> errors(count);
  {
    std::vector<std::jthread> threads;
    threads.reserve(errors.size());
    for (int rank = 0; rank < count; ++rank) {
      threads.emplace_back([&, rank] {
        try {
          work(ThreadRank(mail, rank, count));
        } catch (...) {
          errors[rank] = std::current_exception();
        }
      });
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return mail.traffic();
}

}  // namespace mimetra::test
