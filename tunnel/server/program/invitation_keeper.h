// Writes into a server's keys what houses make of their invitations, in a thread of its own, as
// poses do not wait for a disk.
//
// Units/frames: none.
// Ownership:    owns store and thread; refers to the poller, which must outlive it.
// Threads:      the poller's, and one that it starts.
// Failure:      what cannot be written is kNotKept, and its reason is told. At most kMost wait, one
//               for each guest; further ones are left out, as houses ask again.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/net/poller.h"
#include "core/net/system/wake_event.h"
#include "tunnel/seal/seal_server.h"
#include "tunnel/server/program/key_store.h"

namespace dance {

class InvitationKeeper {
 public:
  static constexpr std::size_t kMost = 64;
  struct Kept {
    SealServer::PeerId peer = 0;
    GuestId guest;
    Result<Binding> binding = Binding::kUnknown;
  };
  using OnKept = std::function<void(const Kept&)>;

  // `on_kept` is called in the poller's thread.
  InvitationKeeper(std::unique_ptr<KeyStore> store, WakeEvent wake, Poller& poller, OnKept on_kept);
  ~InvitationKeeper();
  InvitationKeeper(const InvitationKeeper&) = delete;
  InvitationKeeper& operator=(const InvitationKeeper&) = delete;

  void bind(SealServer::PeerId peer, const GuestId& guest, const PublicKey& house);

 private:
  struct Request {
    SealServer::PeerId peer = 0;
    GuestId guest;
    PublicKey house;
  };
  void run();
  void take_kept();

  std::unique_ptr<KeyStore> store_;
  Poller& poller_;
  OnKept on_kept_;
  WakeEvent wake_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  std::deque<Request> requests_;  // guarded; the first is under way
  std::deque<Kept> kept_;         // guarded
  bool ends_ = false;             // guarded
  std::thread thread_;
};

}  // namespace dance
