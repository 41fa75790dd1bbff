#include "tunnel/link/signals/link_chat.h"

#include <algorithm>

namespace dance {

std::size_t LinkChat::encode(const LocalGuest& guest,
                             std::array<std::uint8_t, wire::kMaxStatePayload>& payload) const {
  wire::ChatHistory history = guest.chat.history;
  for (Chat& chat : history.entries)
    chat.time = MonoTime::from_us(link_.clock.to_theirs_us(chat.time));
  return wire::build(history, payload);
}

bool LinkChat::write(LocalGuest& guest, const Chat& chat, MonoTime now) {
  if (!is_valid(chat)) {
    ++link_.counters.states_invalid;
    return false;
  }
  ChatOutbox& outbox = guest.chat;
  if (!outbox.budget.take(chat, now)) {
    ++link_.counters.chats_limited;
    return false;
  }
  auto& entries = outbox.history.entries;
  // The sequence begins at random, so that after a restart it does not continue an earlier one.
  if (entries.empty())
    outbox.history.sequence = static_cast<std::uint32_t>(
        link_.options.token + static_cast<std::uint64_t>(now.since_zero_us()));
  ++outbox.history.sequence;
  if (entries.is_full()) entries.erase_at(0);
  Chat own = chat;
  const MonoTime earliest = entries.empty() ? own.time : entries[entries.size() - 1].time;
  const bool is_of_now = own.clock_id == link_.options.clock_id && own.time <= now;
  own.time = std::max(is_of_now ? own.time : now, earliest);
  const bool pushed = entries.try_push(own);
  DANCE_ASSERT(pushed);
  std::array<std::uint8_t, wire::kMaxStatePayload> payload;
  const std::size_t size = encode(guest, payload);
  return guest.states[wire::place_of({wire::StateKind::kChat, 0})].change({payload.data(), size});
}

void LinkChat::map_times() {
  for (LocalGuest& guest : link_.locals) {
    ReplicatedState& state = guest.states[wire::place_of({wire::StateKind::kChat, 0})];
    if (guest.chat.history.entries.empty()) continue;
    std::array<std::uint8_t, wire::kMaxStatePayload> payload;
    const std::size_t size = encode(guest, payload);
    state.set(state.version, {payload.data(), size});
  }
}

LinkChat::Received& LinkChat::received_of(const GuestId& guest) {
  auto* found = std::find_if(received_.begin(), received_.end(),
                             [&](const Received& received) { return received.guest == guest; });
  if (found != received_.end()) {
    std::rotate(found, found + 1, received_.end());
    return received_[received_.size() - 1];
  }
  if (received_.is_full()) received_.erase_at(0);
  const bool pushed = received_.try_push({guest, {}, {}});
  DANCE_ASSERT(pushed);
  return received_[received_.size() - 1];
}

bool LinkChat::deliver(const GuestId& guest, wire::Bytes payload, MonoTime now) {
  const auto history = wire::parse_chat(payload);
  if (!history) return false;
  Received& received = received_of(guest);
  const std::size_t size = history->entries.size();
  const std::size_t count = received.sequence ? history->count_new(*received.sequence) : size;
  if (count > 0) received.sequence = history->sequence;
  for (std::size_t i = size - count; i < size; ++i) {
    Chat chat = history->entries[i];
    chat.time = std::min(link_.clock.to_ours(chat.time.since_zero_us()), now);
    chat.clock_id = link_.options.clock_id;
    if (now - chat.time > kHolds) continue;
    if (!received.budget.take(chat, now)) {
      ++link_.counters.chats_limited;
      continue;
    }
    if (link_.handlers.on_chat) link_.handlers.on_chat(guest, chat, now);
  }
  return true;
}

}  // namespace dance
