#include "tunnel/nats/values/nats_inbox.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include "core/base/assert.h"

namespace dance {

NatsInbox::NatsInbox() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  DANCE_ASSERT(fd_ >= 0, fd_);
  waiting_.reserve(kMost);
  taken_.reserve(kMost);
}

NatsInbox::~NatsInbox() { close(fd_); }

void NatsInbox::push(Kind kind, NatsHandle<natsMsg> message) {
  bool is_first = false;
  {
    const std::lock_guard lock(mutex_);
    // That the connection is back is never lost.
    if (waiting_.size() >= kMost && kind != Kind::kBack) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      if (kind == Kind::kValue) missed_value_ = true;
      return;
    }
    is_first = waiting_.empty();
    waiting_.push_back({kind, std::move(message)});
  }
  if (is_first) eventfd_write(fd_, 1);
}

std::vector<NatsInbox::Item>& NatsInbox::take() {
  taken_.clear();
  eventfd_t ignored = 0;
  eventfd_read(fd_, &ignored);
  const std::lock_guard lock(mutex_);
  std::swap(waiting_, taken_);
  return taken_;
}

}  // namespace dance
