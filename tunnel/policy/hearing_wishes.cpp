#include "tunnel/policy/hearing_wishes.h"

namespace dance {

void HearingWishes::hear(const HearingWish& wish, MonoTime now) {
  expire(now);
  Hearing hearing;
  hearing.others = wish.hears_others;
  for (const GuestId& guest : wish.guests)
    if (guest.is_set()) (void)hearing.exceptions.try_push(guest);
  (void)said_.hear(wish.listener, hearing, now);
}

Hearing HearingWishes::within(const Hearing& own) const {
  if (!is_any()) return own;
  Hearing wanted = said_.all()[0].wish;
  for (const auto& said : said_.all()) wanted = either_of(wanted, said.wish);
  return both_of(own, wanted);
}

}  // namespace dance
