#include "tunnel/policy/interest_wishes.h"

#include <algorithm>

namespace dance {

void InterestWishes::hear(const InterestWish& wish, MonoTime now) {
  expire(now);
  Said said;
  said.viewer = wish.viewer;
  said.at = now;
  for (const GuestId& guest : wish.hidden)
    if (guest.is_set() && !said.hidden.contains(guest)) (void)said.hidden.try_push(guest);
  for (Said& known : said_) {
    if (known.viewer != wish.viewer) continue;
    known = said;
    return;
  }
  if (!said_.try_push(said)) crowded_ = now;
}

bool InterestWishes::expire(MonoTime now) {
  bool has_expired = false;
  for (std::size_t i = said_.size(); i-- > 0;) {
    if (now - said_[i].at <= kHolds) continue;
    said_.erase_at(i);
    has_expired = true;
  }
  if (crowded_.is_set() && now - crowded_ > kHolds) {
    crowded_ = MonoTime();
    has_expired = true;
  }
  return has_expired;
}

bool InterestWishes::is_hidden(const GuestId& guest) const {
  return !said_.empty() && !crowded_.is_set() &&
         std::all_of(said_.begin(), said_.end(),
                     [&](const Said& said) { return said.hidden.contains(guest); });
}

Interest InterestWishes::within(const Interest& own, const Hearing& voices) const {
  Interest wanted = own;
  if (said_.empty()) return wanted;
  for (const GuestId& guest : said_[0].hidden) {
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
