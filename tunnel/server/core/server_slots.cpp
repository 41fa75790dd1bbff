#include "tunnel/server/core/server_slots.h"

#include <tuple>
#include <utility>

#include "core/base/assert.h"
#include "core/base/fnv1a.h"

namespace dance {

namespace {

// Never 0.
std::uint32_t hash_of(const GuestId& guest) { return folded(fnv1a(guest.view())) | 1; }

}  // namespace

std::optional<std::uint8_t> ServerSlots::find(const ServerRoom& room, const GuestId& guest) {
  const std::uint32_t hash = hash_of(guest);
  for (std::size_t slot = 0; slot < room.guests.size(); ++slot)
    if (room.name_hashes[slot] == hash && room.guests[slot].id == guest)
      return static_cast<std::uint8_t>(slot);
  return std::nullopt;
}

std::optional<std::uint8_t> ServerSlots::add_guest(std::size_t index, const GuestId& id,
                                                   std::uint64_t link_token, const OwnerKey& key) {
  ServerSession& session = server_.sessions[index];
  ServerRoom& room = server_.rooms[session.room];
  const auto slot = free_slot(room, session.is_remote());
  if (!slot) return std::nullopt;
  ServerGuest* free = &room.guests[*slot];
  *free = ServerGuest();
  free->in_use = true;
  free->id = id;
  room.name_hashes[*slot] = hash_of(id);
  free->link_token = link_token;
  free->key = key;
  free->generation = room.next_generation++;
  free->records = TokenBucket(server_.limits.records_per_second, server_.limits.record_burst);
  free->state_changes =
      TokenBucket(server_.limits.state_changes_per_second, server_.limits.state_change_burst);
  free->channel_records =
      TokenBucket(server_.limits.channel_records_per_second, server_.limits.channel_record_burst);
  free->channel_bytes =
      TokenBucket(server_.limits.channel_bytes_per_second, server_.limits.channel_byte_burst);
  free->voice.packets = TokenBucket(server_.limits.voices_per_second, server_.limits.voice_burst);
  free->voice.bytes =
      TokenBucket(server_.limits.voice_bytes_per_second, server_.limits.voice_byte_burst);
  free->owner = index;
  const bool pushed = session.slots.try_push(*slot);
  DANCE_ASSERT(pushed);
  ++room.guest_count;
  begin_slot(room, *slot);
  return slot;
}

void ServerSlots::remove_guest(std::size_t room_index, std::uint8_t slot) {
  ServerRoom& room = server_.rooms[room_index];
  if (server_.cluster != nullptr && server_.is_local(room.guests[slot]))
    server_.cluster->on_guest_left(room, room.guests[slot]);
  want_no_more(room, room.guests[slot]);
  room.guests[slot].in_use = false;
  room.name_hashes[slot] = 0;
  --room.guest_count;
  for (const std::size_t member : room.members) server_.sessions[member].stream.states.forget(slot);
  ++room.roster_version;
  room.roster_changed = true;
  server_.mark_changed(room);
}

void ServerSlots::move_guest(ServerRoom& room, std::uint8_t slot, std::size_t to) {
  server_.sessions[room.guests[slot].owner].slots.erase(slot);
  // A link's own guests are in the first page.
  if (slot >= wire::kSlotsPerPage && !server_.sessions[to].is_remote()) slot = relocate(room, slot);
  ServerGuest& guest = room.guests[slot];
  if (!server_.sessions[to].is_remote()) want_no_more(room, guest);
  guest.owner = to;
  guest.told = {};
  const bool pushed = server_.sessions[to].slots.try_push(slot);
  DANCE_ASSERT(pushed);
}

// With its states; to those who receive it, it is heard anew in another slot.
std::uint8_t ServerSlots::relocate(ServerRoom& room, std::uint8_t slot) {
  const auto free = free_slot(room, false);
  DANCE_ASSERT(free.has_value());
  ServerGuest& guest = room.guests[*free];
  guest = room.guests[slot];
  guest.generation = room.next_generation++;
  guest.poses = guest.hands = StreamGate();
  guest.retained.is_set = false;
  guest.previous = SentPose();
  guest.channels.fill({});
  room.guests[slot].in_use = false;
  room.name_hashes[*free] = std::exchange(room.name_hashes[slot], 0u);
  for (const std::size_t member : room.members) {
    server_.sessions[member].stream.states.forget(slot);
    server_.sessions[member].stream.states.forget(*free);
  }
  begin_slot(room, *free);
  return *free;
}

// Links' own guests from below, those of other servers from the middle of the first page down and
// then in the second: records of the first page have the shorter headers.
std::optional<std::uint8_t> ServerSlots::free_slot(const ServerRoom& room, bool is_remote) {
  constexpr int kHalf = wire::kSlotsPerPage / 2, kPage = wire::kSlotsPerPage;
  const auto free_in = [&](int from, int to, int step) -> std::optional<std::uint8_t> {
    for (int slot = from; slot != to; slot += step)
      if (!room.guests[static_cast<std::size_t>(slot)].in_use)
        return static_cast<std::uint8_t>(slot);
    return std::nullopt;
  };
  if (!is_remote) return free_in(0, kPage, 1);
  for (const auto& [from, to, step] : {std::tuple{kPage - 1, kHalf - 1, -1},
                                       {kPage, static_cast<int>(wire::kMaxGuestsPerRoom), 1},
                                       {kHalf - 1, -1, -1}})
    if (const auto slot = free_in(from, to, step)) return slot;
  return std::nullopt;
}

// It is no guest of another server any more.
void ServerSlots::want_no_more(const ServerRoom& room, ServerGuest& guest) {
  if (std::exchange(guest.is_wanted, false)) server_.cluster->on_wanted(room, guest, false);
}

// Another guest has it: receivers know nothing of this one.
void ServerSlots::begin_slot(ServerRoom& room, std::uint8_t slot) {
  for (const std::size_t member : room.members) {
    ServerSession& receiver = server_.sessions[member];
    receiver.filters[slot] = InterestFilter(receiver.interest.default_divider);
    receiver.voice.muted.set(slot, !receiver.interest.voices.hears_others);
    if (!receiver.is_remote()) continue;
    server_.remote_receivers[receiver.remote].frames[slot] = {};
    server_.remote_receivers[receiver.remote].intra_frames[slot] = 0;
  }
  ++room.roster_version;
  room.roster_changed = true;
  server_.mark_changed(room);
}

}  // namespace dance
