#include "toolkit/mesh/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "toolkit/mesh/context.h"

namespace mimetra {

namespace {

/// State that the threads of one loop share.
class Loop {
 public:
  Loop(int count, const std::function<void(int)>& work) : count_(count), work_(work) {}

  /// Takes one index after the other; calls `after` with the number of finished indices.
  void run(const std::function<void(int)>& after) {
    // Every index taken is also worked on, so all indices below a failed one are finished.
    while (!stopped_) {
      const int i = next_++;
      if (i >= count_) return;
      try {
        work_(i);
        after(++done_);
      } catch (...) {
        stop(i);
      }
    }
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void stop(int index) {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    if (error_ && index > failed_) return;
    failed_ = index;
    error_ = std::current_exception();
  }

  int count_;
  const std::function<void(int)>& work_;
  std::atomic<int> next_ = 0;
  std::atomic<int> done_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::exception_ptr error_;
  int failed_ = 0;
};

}  // namespace

void parallel_for(int count, const std::function<void(int)>& work, const Context& context) {
  const int used = std::min(context.thread_count(), count);
  Loop loop(count, work);
  int reported = 0;
  {
    std::vector<std::jthread> others;
    for (int t = 1; t < used; ++t) others.emplace_back([&loop] { loop.run([](int) {}); });
    loop.run([&](int done) {
      reported = done;
      context.report(double(done) / count);
    });
  }
  loop.rethrow();
  // Other threads may have finished the last indices, or all of them.
  if (reported < count) context.report(1);
}

}  // namespace mimetra
