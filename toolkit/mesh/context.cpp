#include "toolkit/mesh/context.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <thread>
#include <utility>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

class NoOthers : public Ranks {
 public:
  int rank() const override { return 0; }
  int count() const override { return 1; }
  void send(int, std::span<const double>) const override {}
  void receive(int, std::span<double>) const override {}
  void broadcast(int, std::span<double>) const override {}
  void meet(const std::function<bool()>&) const override {}
};

const NoOthers kAlone{};

}  // namespace

struct Context::Shared {
  Progress progress = {};
  Notes notes = {};
  std::optional<double> memory = {};
  const Ranks* ranks = nullptr;
};

IndexRange dealt_to(int owner, int owners, int things) {
  // Thing t goes to owner t owners / things, rounded down.
  const auto first = [&](std::int64_t o) {
    return static_cast<int>((o * things + owners - 1) / owners);
  };
  return {first(owner), first(std::int64_t{owner} + 1)};
}

int owner_of(int thing, int owners, int things) {
  return static_cast<int>(std::int64_t{thing} * owners / things);
}

Context Context::changed(const std::function<void(Shared&)>& change) const {
  Context context = *this;
  auto shared = shared_ ? std::make_shared<Shared>(*shared_) : std::make_shared<Shared>();
  change(*shared);
  context.shared_ = std::move(shared);
  return context;
}

Context Context::with_threads(int threads) const {
  Context context = *this;
  context.threads_ = threads;
  return context;
}

Context Context::with_progress(Progress progress) const {
  Context context = changed([&](Shared& shared) { shared.progress = std::move(progress); });
  context.from_ = 0;
  context.to_ = 1;
  return context;
}

Context Context::with_notes(Notes notes) const {
  Context context = changed([&](Shared& shared) { shared.notes = std::move(notes); });
  context.is_quiet_ = false;
  return context;
}

Context Context::with_memory(std::optional<double> bytes) const {
  return changed([&](Shared& shared) { shared.memory = bytes; });
}

Context Context::with_ranks(const Ranks& ranks) const {
  return changed([&](Shared& shared) { shared.ranks = &ranks; });
}

Context Context::part(double from, double to) const {
  Context context = *this;
  context.from_ = std::lerp(from_, to_, from);
  context.to_ = std::lerp(from_, to_, to);
  return context;
}

Context Context::quiet() const {
  Context context = *this;
  context.is_quiet_ = true;
  return context;
}

Context Context::without_ranks() const {
  if (ranks().count() == 1) return *this;
  return with_ranks(kAlone);
}

int Context::thread_count() const {
  return threads_ > 0 ? threads_
                      : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Context Context::serial() const {
  return Context().with_threads(1).with_memory(memory());
}

std::optional<double> Context::memory() const {
  return shared_ ? shared_->memory : std::nullopt;
}

const Ranks& Context::ranks() const {
  return shared_ && shared_->ranks ? *shared_->ranks : kAlone;
}

void Context::report(double share) const {
  if (!shared_ || !shared_->progress) return;
  if (!shared_->progress(std::lerp(from_, to_, share))) throw Cancelled();
}

void Context::note(std::string text, Topic topic) const {
  if (!is_quiet_ && shared_ && shared_->notes) shared_->notes({topic, std::move(text)});
}

}  // namespace mimetra
