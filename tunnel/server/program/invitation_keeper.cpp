#include "tunnel/server/program/invitation_keeper.h"

#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>

#include "core/base/assert.h"

namespace dance {

InvitationKeeper::InvitationKeeper(std::unique_ptr<KeyStore> store, Poller& poller, OnKept on_kept)
    : store_(std::move(store)), poller_(poller), on_kept_(std::move(on_kept)) {
  wake_fd_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  DANCE_ASSERT(wake_fd_ >= 0);
  poller_.watch(wake_fd_, [this](MonoTime) { take_kept(); });
  thread_ = std::thread([this] { run(); });
}

InvitationKeeper::~InvitationKeeper() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_all();
  thread_.join();
  poller_.unwatch(wake_fd_);
  close(wake_fd_);
}

void InvitationKeeper::bind(SealServer::PeerId peer, const GuestId& guest,
                            const PresharedKey& lasting) {
  {
    const std::lock_guard lock(mutex_);
    const bool is_waiting =
        std::ranges::any_of(wishes_, [&](const Wish& it) { return it.guest == guest; });
    if (is_waiting || wishes_.size() == kMost) return;
    wishes_.push_back({peer, guest, lasting});
  }
  wakes_.notify_one();
}

void InvitationKeeper::run() {
  pthread_setname_np(pthread_self(), "invitations");
  std::unique_lock lock(mutex_);
  for (;;) {
    wakes_.wait(lock, [this] { return ends_ || !wishes_.empty(); });
    if (ends_) return;
    const Wish wish = wishes_.front();
    lock.unlock();
    Result<Binding> binding = store_->bind(std::string(wish.guest.view()), wish.lasting);
    lock.lock();
    wishes_.pop_front();
    kept_.push_back({wish.peer, wish.guest, std::move(binding)});
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto n = write(wake_fd_, &one, sizeof one);
  }
}

void InvitationKeeper::take_kept() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto n = read(wake_fd_, &count, sizeof count);
  std::deque<Kept> kept;
  {
    const std::lock_guard lock(mutex_);
    kept.swap(kept_);
  }
  for (const Kept& each : kept) on_kept_(each);
}

}  // namespace dance
