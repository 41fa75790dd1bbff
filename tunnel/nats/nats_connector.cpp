#include "tunnel/nats/nats_connector.h"

#include <chrono>
#include <utility>

#include "core/net/secure_random.h"

namespace dance {
namespace {

constexpr auto kConnectAgain = std::chrono::milliseconds(150);
// A connection that ended sooner was none: the next is not made at once.
constexpr auto kLasts = std::chrono::seconds(1);

}  // namespace

NatsConnector::NatsConnector(const NatsOptions& options, WakeEvent wake)
    : options_(options),
      next_(secure_random_u64() % options.urls.size()),
      wake_(std::move(wake)),
      thread_([this] { run(); }) {}

NatsConnector::~NatsConnector() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

// The thread waits meanwhile: it has not been asked.
Result<NatsHandshake> NatsConnector::connect_now() {
  Result<NatsHandshake> made = fail("NATS: no server is named");
  for (std::size_t i = 0; i < options_.urls.size() && !made; ++i)
    made = handshake_nats(options_, options_.urls[next_++ % options_.urls.size()], ends_);
  made_at_ = std::chrono::steady_clock::now();
  return made;
}

void NatsConnector::ask() {
  {
    const std::lock_guard lock(mutex_);
    is_asked_ = true;
  }
  changed_.notify_all();
}

std::optional<NatsHandshake> NatsConnector::take() {
  wake_.clear();
  const std::lock_guard lock(mutex_);
  return std::exchange(made_, std::nullopt);
}

void NatsConnector::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || is_asked_; });
    if (!ends_ && std::chrono::steady_clock::now() - made_at_ < kLasts)
      changed_.wait_for(lock, kConnectAgain, [this] { return ends_.load(); });
    if (ends_) return;
    lock.unlock();
    auto made = handshake_nats(options_, options_.urls[next_++ % options_.urls.size()], ends_);
    lock.lock();
    if (made) {
      made_at_ = std::chrono::steady_clock::now();
      is_asked_ = false;
      made_.emplace(std::move(*made));
      wake_.signal();
    } else {
      changed_.wait_for(lock, kConnectAgain, [this] { return ends_.load(); });
    }
  }
}

}  // namespace dance
