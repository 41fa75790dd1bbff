#include "lobby/run/invitation_opener.h"

#include <algorithm>

#include "tunnel/invitation/open_invitation.h"

namespace dance {

InvitationOpener::~InvitationOpener() {
  if (thread_.joinable()) thread_.join();
}

bool InvitationOpener::begin(const Invitation& invitation, bool trusts_new_key) {
  if (is_busy_.load(std::memory_order_acquire)) return false;
  if (thread_.joinable()) thread_.join();
  outcome_.take();  // of one that nobody waits for any more
  invitation_ = invitation;
  is_busy_.store(true, std::memory_order_release);
  thread_ = std::thread([this, invitation, trusts_new_key] {
    Outcome outcome;
    if (const auto opened = open_invitation(invitation, trusts_new_key); !opened) {
      const std::string& what = opened.error().what;
      std::copy_n(what.begin(), std::min(what.size(), outcome.trouble.size() - 1),
                  outcome.trouble.begin());
    }
    outcome_.put(outcome);
    is_busy_.store(false, std::memory_order_release);
    is_done_();
  });
  return true;
}

std::optional<std::string> InvitationOpener::take() {
  const Outcome* outcome = outcome_.take();
  if (outcome == nullptr) return std::nullopt;
  return std::string(outcome->trouble.data());
}

}  // namespace dance
