#include "tunnel/server/program/invitation_keeper.h"

#include <pthread.h>

#include <algorithm>

namespace dance {

InvitationKeeper::InvitationKeeper(std::unique_ptr<KeyStore> store, WakeEvent wake, Poller& poller,
                                   OnKept on_kept)
    : store_(std::move(store)),
      poller_(poller),
      on_kept_(std::move(on_kept)),
      wake_(std::move(wake)) {
  poller_.watch(wake_.fd(), [this](MonoTime) { take_kept(); });
  thread_ = std::thread([this] { run(); });
}

InvitationKeeper::~InvitationKeeper() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_all();
  thread_.join();
  poller_.unwatch(wake_.fd());
}

void InvitationKeeper::bind(SealServer::PeerId peer, const GuestId& guest, const PublicKey& house) {
  {
    const std::lock_guard lock(mutex_);
    const bool is_waiting =
        std::ranges::any_of(requests_, [&](const Request& it) { return it.guest == guest; });
    if (is_waiting || requests_.size() == kMost) return;
    requests_.push_back({peer, guest, house});
  }
  wakes_.notify_one();
}

void InvitationKeeper::run() {
  pthread_setname_np(pthread_self(), "invitations");
  std::unique_lock lock(mutex_);
  for (;;) {
    wakes_.wait(lock, [this] { return ends_ || !requests_.empty(); });
    if (ends_) return;
    const Request request = requests_.front();
    lock.unlock();
    Result<Binding> binding = store_->bind(std::string(request.guest.view()), request.house);
    lock.lock();
    requests_.pop_front();
    kept_.push_back({request.peer, request.guest, std::move(binding)});
    wake_.signal();
  }
}

void InvitationKeeper::take_kept() {
  wake_.clear();
  std::deque<Kept> kept;
  {
    const std::lock_guard lock(mutex_);
    kept.swap(kept_);
  }
  for (const Kept& each : kept) on_kept_(each);
}

}  // namespace dance
