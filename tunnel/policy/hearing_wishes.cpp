#include "tunnel/policy/hearing_wishes.h"

namespace dance {

void HearingWishes::hear(const HearingWish& wish, MonoTime now) {
  expire(now);
  Said said{wish.listener, {}, now};
  said.hearing.others = wish.hears_others;
  for (const GuestId& guest : wish.guests)
    if (guest.is_set()) (void)said.hearing.exceptions.try_push(guest);
  for (Said& known : said_) {
    if (known.guest != wish.listener) continue;
    known = said;
    return;
  }
  (void)said_.try_push(said);
}

bool HearingWishes::expire(MonoTime now) {
  const std::size_t before = said_.size();
  for (std::size_t i = said_.size(); i-- > 0;)
    if (now - said_[i].at > kHolds) said_.erase_at(i);
  return said_.size() != before;
}

Hearing HearingWishes::within(const Hearing& own) const {
  if (said_.empty()) return own;
  Hearing wanted = said_[0].hearing;
  for (const Said& said : said_) wanted = either_of(wanted, said.hearing);
  return both_of(own, wanted);
}

}  // namespace dance
