#include "tunnel/policy/interest_wishes.h"

#include <algorithm>

namespace dance {

void InterestWishes::hear(const InterestWish& wish, MonoTime now) {
  expire(now);
  Hidden hidden;
  for (const GuestId& guest : wish.hidden)
    if (guest.is_set() && !hidden.contains(guest)) (void)hidden.try_push(guest);
  if (!said_.hear(wish.viewer, hidden, now)) crowded_ = now;
}

bool InterestWishes::expire(MonoTime now) {
  bool has_expired = said_.expire(now);
  if (crowded_.is_set() && now - crowded_ > kHolds) {
    crowded_ = MonoTime();
    has_expired = true;
  }
  return has_expired;
}

bool InterestWishes::is_hidden(const GuestId& guest) const {
  const auto& all = said_.all();
  return !all.empty() && !crowded_.is_set() &&
         std::all_of(all.begin(), all.end(),
                     [&](const auto& said) { return said.wish.contains(guest); });
}

Interest InterestWishes::within(const Interest& own, const Hearing& voices) const {
  Interest wanted = own;
  if (said_.all().empty()) return wanted;
  for (const GuestId& guest : said_.all()[0].wish) {
    if (!is_hidden(guest)) continue;
    const std::uint8_t divider = voices.hears(guest) ? kFewest : 0;
    const auto named = std::find_if(wanted.guests.begin(), wanted.guests.end(),
                                    [&](const Interest::One& one) { return one.guest == guest; });
    if (named == wanted.guests.end()) {
      if (own.others != 0) (void)wanted.guests.try_push({guest, divider});
    } else if (named->divider != 0) {
      named->divider = divider;
    }
  }
  return wanted;
}

}  // namespace dance
