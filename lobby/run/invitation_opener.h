// InvitationOpener: opens an invitation (tunnel/invitation/) in a thread of its own, as its server
// is asked for up to twenty seconds.
//
// Units/frames: none.
// Ownership:    owns the thread; the destructor waits for it.
// Threads:      begin() and take() on the drawing thread.
// Failure:      take() gives the words for what went wrong.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "core/base/latest.h"
#include "tunnel/invitation/invitation.h"

namespace dance {

class InvitationOpener {
 public:
  explicit InvitationOpener(std::function<void()> is_done) : is_done_(std::move(is_done)) {}
  ~InvitationOpener();
  InvitationOpener(const InvitationOpener&) = delete;
  InvitationOpener& operator=(const InvitationOpener&) = delete;

  // False while one is being opened. `trusts_new_key`: as OpenInvitation's.
  bool begin(const Invitation& invitation, bool trusts_new_key);
  // "" = it is open; once.
  std::optional<std::string> take();
  const Invitation& invitation() const { return invitation_; }

 private:
  struct Outcome {
    std::array<char, 400> trouble{};
  };
  std::function<void()> is_done_;
  Invitation invitation_;
  std::atomic<bool> is_busy_{false};
  Latest<Outcome> outcome_;
  std::thread thread_;
};

}  // namespace dance
