#include "tunnel/nats/nats_sender.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>

#include "core/base/assert.h"

namespace dance {

NatsSender::NatsSender(natsConnection* connection, NatsInbox& inbox)
    : connection_(connection),
      inbox_(inbox),
      wake_fd_(eventfd(0, EFD_CLOEXEC)),
      slots_(kSlots),
      thread_([this] { run(); }) {
  DANCE_ASSERT(wake_fd_ >= 0, wake_fd_);
}

NatsSender::~NatsSender() {
  ends_ = true;
  eventfd_write(wake_fd_, 1);
  thread_.join();
  close(wake_fd_);
}

void NatsSender::push(Kind kind, std::string_view subject, std::span<const std::uint8_t> message) {
  const std::uint64_t at = pushed_.load(std::memory_order_relaxed);
  Slot& slot = slots_[at % kSlots];
  if (at - carried_out_.load(std::memory_order_acquire) == kSlots ||
      message.size() > slot.bytes.size()) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  slot.kind = kind;
  const bool fits = slot.subject.assign(subject);
  DANCE_ASSERT(fits, subject.size());
  slot.size = message.size();
  std::copy(message.begin(), message.end(), slot.bytes.begin());
  pushed_.store(at + 1);
  if (sleeps_.exchange(false)) eventfd_write(wake_fd_, 1);
}

void NatsSender::run() {
  while (!ends_) {
    const std::uint64_t at = carried_out_.load(std::memory_order_relaxed);
    if (at == pushed_.load()) {
      sleeps_ = true;
      // Pushed since: nobody may have seen that this thread sleeps.
      if (at != pushed_.load() || ends_) {
        sleeps_ = false;
        continue;
      }
      eventfd_t ignored = 0;
      eventfd_read(wake_fd_, &ignored);
      continue;
    }
    carry_out(slots_[at % kSlots]);
    carried_out_.store(at + 1, std::memory_order_release);
  }
}

void NatsSender::carry_out(const Slot& slot) {
  switch (slot.kind) {
    case Kind::kPublish:
      // The library would keep it for when there is a connection again, and send what is old.
      if (natsConnection_Status(connection_) != NATS_CONN_STATUS_CONNECTED ||
          natsConnection_Publish(connection_, slot.subject.c_str(), slot.bytes.data(),
                                 static_cast<int>(slot.size)) != NATS_OK)
        dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    case Kind::kListen:
      return subscribe(slot.subject.c_str());
    case Kind::kEndListen:
      subscriptions_.erase(slot.subject.c_str());
      return;
  }
}

void NatsSender::subscribe(const std::string& subject) {
  natsSubscription* subscription = nullptr;
  const auto on_message = [](natsConnection*, natsSubscription*, natsMsg* message, void* inbox) {
    static_cast<NatsInbox*>(inbox)->push(NatsInbox::Kind::kMessage, NatsHandle<natsMsg>(message));
  };
  // The library says it again itself when it connects again.
  if (natsConnection_Subscribe(&subscription, connection_, subject.c_str(), on_message, &inbox_) ==
      NATS_OK)
    subscriptions_[subject].reset(subscription);
  else
    dropped_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace dance
