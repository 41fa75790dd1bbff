#include "tunnel/nats/values/nats_inbox.h"

namespace dance {

NatsInbox::NatsInbox(WakeEvent wake) : wake_(std::move(wake)) {
  waiting_.reserve(kMost);
  taken_.reserve(kMost);
}

void NatsInbox::push(Kind kind, NatsHandle<natsMsg> message) {
  bool is_first = false;
  {
    const std::lock_guard lock(mutex_);
    // Events of the connection and of the bucket are never dropped.
    if (waiting_.size() >= kMost && kind == Kind::kValue) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      missed_value_ = true;
      return;
    }
    is_first = waiting_.empty();
    waiting_.push_back({kind, std::move(message)});
  }
  if (is_first) wake_.signal();
}

std::vector<NatsInbox::Item>& NatsInbox::take() {
  taken_.clear();
  wake_.clear();
  const std::lock_guard lock(mutex_);
  std::swap(waiting_, taken_);
  return taken_;
}

}  // namespace dance
