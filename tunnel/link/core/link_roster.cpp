#include "tunnel/link/core/link_roster.h"

#include <algorithm>

namespace dance {

void LinkRoster::renew_decoder(RemoteGuest& remote) {
  remote.decoder = link_.options.make_decoder(link_.codec);
  remote.intra_asked_at = MonoTime();
  // Only what this guest has told since it came: its encoder begins with nothing too.
  if (remote.heard.state_versions[wire::place_of({wire::StateKind::kSkeleton, 0})] != 0 &&
      remote.has_skeleton)
    remote.decoder->set_skeleton(remote.skeleton);
}

void LinkRoster::settle_slot(RemoteGuest& remote, const wire::RosterEntry* entry) {
  if (entry == nullptr) {
    link_.remotes.keep_counts(remote);
    remote.in_use = false;
    return;
  }
  const bool is_same =
      remote.in_use && remote.id == entry->guest && remote.generation == entry->slot.generation;
  if (!is_same) link_.remotes.keep_counts(remote);
  remote.is_ours = link_.locals.is_ours(*entry);
  if (is_same) return;
  // What was known of the guest's proportions, in this slot or another, still holds until the
  // server says more.
  const auto known =
      std::find_if(link_.remotes.begin(), link_.remotes.end(),
                   [&](const RemoteGuest& r) { return r.has_skeleton && r.id == entry->guest; });
  remote.has_skeleton = known != link_.remotes.end();
  if (remote.has_skeleton) remote.skeleton = known->skeleton;
  remote.in_use = true;
  remote.id = entry->guest;
  remote.generation = entry->slot.generation;
  remote.heard = {};
  remote.shown = MonoTime();
  remote.counts = {};
  renew_decoder(remote);
}

bool LinkRoster::on_roster(wire::Bytes body, MonoTime now) {
  const auto part = wire::parse_roster(body);
  if (!part) return false;
  if (!roster_.take(*part)) return true;  // overtaken by a newer one: nothing wrong with it
  FixedList<GuestId, wire::kMaxGuestsPerRoom> before;
  FixedList<GuestId, wire::kMaxGuestsPerRoom> named;
  for (const RemoteGuest& remote : link_.remotes)
    if (remote.in_use && !remote.is_ours && !before.try_push(remote.id)) return false;
  for (std::size_t i = 0; i < part->slot_span; ++i) {
    const std::size_t slot = part->first_slot + i;
    const auto entry = std::find_if(part->entries.begin(), part->entries.end(),
                                    [&](const auto& e) { return e.slot.slot == slot; });
    const bool is_taken = entry != part->entries.end();
    settle_slot(link_.remotes[slot], is_taken ? entry : nullptr);
    if (is_taken && !link_.remotes[slot].is_ours && !named.try_push(entry->guest)) return false;
  }
  // Who merely changed the slot neither left nor came.
  for (const GuestId& id : before)
    if (!link_.remotes.is_present(id) && link_.handlers.on_guest_left)
      link_.handlers.on_guest_left(id, now);
  for (const GuestId& id : named)
    if (!before.contains(id) && link_.handlers.on_guest_joined)
      link_.handlers.on_guest_joined(id, now);
  return true;
}

void LinkRoster::begin_session() {
  forget();
  for (RemoteGuest& remote : link_.remotes) {
    link_.remotes.keep_counts(remote);
    remote.heard = {};
    if (remote.decoder) renew_decoder(remote);
  }
}

}  // namespace dance
