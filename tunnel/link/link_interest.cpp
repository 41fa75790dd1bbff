// Whom this house wants to hear.
#include <algorithm>

#include "tunnel/link/link_core.h"

namespace dance {

void LinkCore::set_interest(const Interest& interest, MonoTime) {
  options_.interest = interest;
  if (is_welcome_) settle_interest();
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
  if (interest_.change(wanted) && is_connected()) tell_interest();
}

void LinkCore::tell_interest() {
  std::array<std::uint8_t, wire::kMaxHello> out;
  send_datagram({out.data(), wire::build(interest_.list(), out)});
}

bool LinkCore::on_interest_ack(wire::Bytes body) {
  const auto version = wire::parse_interest_ack(body);
  if (!version) return false;
  interest_.take_ack(*version);
  return true;
}

}  // namespace dance
