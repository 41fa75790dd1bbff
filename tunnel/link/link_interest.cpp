// Whom this house wants to hear.
#include <algorithm>

#include "tunnel/link/link_core.h"

namespace dance {

void LinkCore::set_interest(const Interest& interest, MonoTime) {
  options_.interest = interest;
  if (is_welcome_) settle_interest();
}

// The hello has told what counts for those who are not named.
void LinkCore::begin_session_interest() {
  interest_.default_divider = options_.interest.others;
  interest_.entries.clear();
  interest_acked_ = interest_.version;
}

void LinkCore::settle_interest() {
  wire::InterestList wanted;
  wanted.default_divider = options_.interest.others;
  for (std::size_t slot = 0; slot < remotes_.size(); ++slot) {
    const RemoteGuest& remote = remotes_[slot];
    if (!remote.in_use || remote.is_ours) continue;
    const std::uint8_t divider = options_.interest.divider_of(remote.id);
    if (divider == wanted.default_divider) continue;
    (void)wanted.entries.try_push(  // as many as there are slots
        {{static_cast<std::uint8_t>(slot), remote.generation}, divider});
  }
  if (wanted.default_divider == interest_.default_divider &&
      std::equal(wanted.entries.begin(), wanted.entries.end(), interest_.entries.begin(),
                 interest_.entries.end()))
    return;
  wanted.version = interest_.version + 1;
  if (wanted.version == 0) wanted.version = 1;
  interest_ = wanted;
  if (is_connected()) tell_interest();
}

void LinkCore::tell_interest() {
  std::array<std::uint8_t, wire::kMaxHello> out;
  send_datagram({out.data(), wire::build(interest_, out)});
}

bool LinkCore::on_interest_ack(wire::Bytes body) {
  const auto version = wire::parse_interest_ack(body);
  if (!version) return false;
  // The server took something for a later list of ours: ours must be later still.
  if (interest_.version == 0 || is_newer_sequence(*version, interest_.version))
    interest_.version = *version + 1 == 0 ? 1 : *version + 1;
  if (*version == interest_.version) interest_acked_ = *version;
  return true;
}

}  // namespace dance
