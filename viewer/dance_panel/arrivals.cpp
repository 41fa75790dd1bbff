#include "viewer/dance_panel/arrivals.h"

#include <algorithm>

namespace dance {
namespace {

bool is_here(const DanceGuest& guest, MonoTime now) {
  return guest.is_remote && now - guest.named < Arrivals::kGone;
}

}  // namespace

void Arrivals::add(const GuestId& guest, bool has_joined, MonoTime now) {
  // A guest who returns at once has one message: the newest.
  std::erase_if(messages_, [&](const Message& message) { return message.guest == guest; });
  if (messages_.size() == kMostShown) messages_.erase(messages_.begin());
  messages_.push_back({guest, has_joined, now});
}

void Arrivals::work(const DanceRecords& records, MonoTime now) {
  std::erase_if(messages_, [&](const Message& message) { return now - message.at > kShown; });
  const bool is_connected =
      records.link() && records.link()->link.state == HouseLinkState::kConnected;
  if (!is_connected) {
    connected_ = MonoTime();
    return;
  }
  if (!connected_.is_set()) connected_ = now;
  const bool announces = now - connected_ > kSettles;
  for (const DanceGuest& guest : records.guests()) {
    const auto at = std::lower_bound(here_.begin(), here_.end(), guest.id);
    if (!is_here(guest, now) || (at != here_.end() && *at == guest.id)) continue;
    here_.insert(at, guest.id);
    if (announces) add(guest.id, true, now);
  }
  if (!announces) return;
  std::erase_if(here_, [&](const GuestId& id) {
    const DanceGuest* guest = records.find(id);
    const bool has_left = guest == nullptr || !is_here(*guest, now);
    if (has_left) add(id, false, now);
    return has_left;
  });
}

}  // namespace dance
