#include "house/house_profiles.h"

#include <algorithm>

namespace dance {
namespace {

// A file that holds only this house's own captures does not count as recording the others.
bool records_others(const HostedConsumer& consumer) {
  return find_consumer_kind(consumer.to)->output == OutputKind::kFile &&
         consumer.from.where != Where::kCapture;
}

}  // namespace

HouseProfiles::HouseProfiles(const HouseConfig& session, SignalPort& inputs, SignalPort& port,
                             std::uint64_t clock_id)
    : port_(port), clock_id_(clock_id) {
  // A house that only watches has no guest in the room.
  for (const GuestId& guest : session.watch ? std::vector<GuestId>() : session.guests) {
    const auto named = session.shown_names.find(guest);
    guests_.push_back({guest, named == session.shown_names.end() ? ShownName() : named->second});
  }
  records_itself_ = std::any_of(session.consumers.begin(), session.consumers.end(), records_others);
  inputs.subscribe<RecordingState>(
      Where::kLocal, [this](const Channel&, const RecordingState& state, MonoTime now) {
        on_recording(state, now);
      });
  inputs.subscribe<Profile>({Where::kCapture, GuestId()},
                            [this](const Channel& channel, const Profile& profile, MonoTime now) {
                              on_profile(channel.guest(), profile, now);
                            });
}

// The program that renames a guest does not know all signs, so the whole profile is published
// again, also for a name that the guest has already.
void HouseProfiles::on_profile(const GuestId& guest, const Profile& profile, MonoTime now) {
  if (std::ranges::find(published_us_, profile.time.since_zero_us()) != published_us_.end()) return;
  const auto own = std::ranges::find(guests_, guest, &Own::guest);
  if (own == guests_.end()) return;
  own->name = profile.shown_name;
  own->is_published = true;
  publish(now);
}

void HouseProfiles::on_recording(const RecordingState& state, MonoTime now) {
  const bool was_recording = is_recording();
  auto* known = std::find_if(windows_.begin(), windows_.end(),
                             [&](const Window& window) { return window.viewer == state.viewer; });
  if (known == windows_.end()) {
    if (state.is_recording) (void)windows_.try_push({state.viewer, now});
  } else if (state.is_recording) {
    known->reported = now;
  } else {
    windows_.erase_at(static_cast<std::size_t>(known - windows_.begin()));
  }
  if (is_recording() != was_recording) publish(now);
}

void HouseProfiles::publish_second(MonoTime now) {
  for (std::size_t i = windows_.size(); i-- > 0;)
    if (now - windows_[i].reported > kWindowHolds) windows_.erase_at(i);
  publish(now);
}

void HouseProfiles::publish(MonoTime now) {
  published_us_[next_published_++ % published_us_.size()] = now.since_zero_us();
  for (Own& own : guests_) {
    own.is_published = own.is_published || !own.name.empty() || is_recording();
    if (own.is_published)
      port_.publish(Where::kCapture, own.guest,
                    Profile{now, clock_id_, own.name, is_recording(), false});
  }
}

}  // namespace dance
