#include "tunnel/nats/nats_sender.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr int kTryAgain_ms = 100;

}  // namespace

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

void NatsSender::wake() { eventfd_write(wake_fd_, 1); }

void NatsSender::push(std::string_view subject, std::span<const std::uint8_t> message) {
  const std::uint64_t at = pushed_.load(std::memory_order_relaxed);
  Slot& slot = slots_[at % kSlots];
  if (at - carried_out_.load(std::memory_order_acquire) == kSlots ||
      message.size() > slot.bytes.size()) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  const bool fits = slot.subject.assign(subject);
  DANCE_ASSERT(fits, subject.size());
  slot.size = message.size();
  std::copy(message.begin(), message.end(), slot.bytes.begin());
  pushed_.store(at + 1);
  if (sleeps_.exchange(false)) wake();
}

void NatsSender::listen(std::string_view subject) {
  {
    const std::lock_guard lock(mutex_);
    wanted_.emplace(subject);
  }
  wants_change_ = true;
  wake();
}

void NatsSender::end_listen(std::string_view subject) {
  {
    const std::lock_guard lock(mutex_);
    wanted_.erase(std::string(subject));
  }
  wants_change_ = true;
  wake();
}

void NatsSender::flush(std::chrono::milliseconds longest) {
  const auto end = std::chrono::steady_clock::now() + longest;
  while (carried_out_.load() != pushed_.load() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void NatsSender::run() {
  while (!ends_) {
    if (wants_change_.exchange(false) && !settle_subscriptions()) wants_change_ = true;
    const std::uint64_t at = carried_out_.load(std::memory_order_relaxed);
    if (at != pushed_.load()) {
      publish(slots_[at % kSlots]);
      carried_out_.store(at + 1, std::memory_order_release);
      continue;
    }
    sleeps_ = true;
    // Pushed since: nobody may have seen that this thread sleeps.
    if (at == pushed_.load() && !ends_) {
      pollfd woken{wake_fd_, POLLIN, 0};
      const bool tries_again = wants_change_;
      if (poll(&woken, 1, tries_again ? kTryAgain_ms : -1) > 0) {
        eventfd_t ignored = 0;
        eventfd_read(wake_fd_, &ignored);
      }
    }
    sleeps_ = false;
  }
}

void NatsSender::publish(const Slot& slot) {
  // The library would keep it for when there is a connection again, and send what is old.
  if (natsConnection_Status(connection_) != NATS_CONN_STATUS_CONNECTED ||
      natsConnection_Publish(connection_, slot.subject.c_str(), slot.bytes.data(),
                             static_cast<int>(slot.size)) != NATS_OK)
    dropped_.fetch_add(1, std::memory_order_relaxed);
}

// False where something could not be subscribed to now.
bool NatsSender::settle_subscriptions() {
  std::set<std::string> wanted;
  {
    const std::lock_guard lock(mutex_);
    wanted = wanted_;
  }
  std::erase_if(subscriptions_, [&](const auto& it) { return !wanted.contains(it.first); });
  bool is_settled = true;
  for (const std::string& subject : wanted)
    if (!subscriptions_.contains(subject)) is_settled = subscribe(subject) && is_settled;
  return is_settled;
}

bool NatsSender::subscribe(const std::string& subject) {
  natsSubscription* subscription = nullptr;
  const auto on_message = [](natsConnection*, natsSubscription*, natsMsg* message, void* inbox) {
    static_cast<NatsInbox*>(inbox)->push(NatsInbox::Kind::kMessage, NatsHandle<natsMsg>(message));
  };
  // The library says it again itself when it connects again.
  if (natsConnection_Subscribe(&subscription, connection_, subject.c_str(), on_message, &inbox_) !=
      NATS_OK)
    return false;
  subscriptions_[subject].reset(subscription);
  return true;
}

}  // namespace dance
