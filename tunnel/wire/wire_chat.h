// The payload of a guest's chat, a state: its newest lines and signs, so that one whose datagram is
// lost arrives with the next. Receivers drop those that they have, by the sequence.
// docs/wire-format.md documents the bytes.
//
// Units/frames: little-endian; times in µs of the server's clock.
// Ownership:    plain values; nothing here allocates.
// Threads:      none inside.
// Failure:      parse_chat() returns nullopt unless all bytes are valid lines and signs.
#pragma once

#include "core/base/fixed_list.h"
#include "core/bus/chat.h"
#include "tunnel/wire/wire_state.h"

namespace dance::wire {

constexpr std::size_t kMostChatEntries = 4;

// The newest lines and signs of a guest, oldest first.
struct ChatHistory {
  std::uint32_t sequence = 0;  // of the newest entry; one less for the entry before it
  FixedList<Chat, kMostChatEntries> entries;

  // The number of entries, from the end, that are new to a receiver whose newest has the sequence
  // `known`. After a restart of the guest's house the sequence does not continue `known`: then all
  // entries are new.
  std::size_t count_new(std::uint32_t known) const {
    const std::uint32_t ahead = sequence - known, behind = known - sequence;
    if (behind < kMostChatEntries) return 0;
    return ahead < entries.size() ? ahead : entries.size();
  }
};

// Writes the newest entry, then the ones before it while they fit; returns the number of bytes.
// The history must not be empty.
std::size_t build(const ChatHistory& history, std::span<std::uint8_t, kMaxStatePayload> out);
// Times are the server's, as the writer claims them; `clock_id` of the entries is 0.
std::optional<ChatHistory> parse_chat(Bytes payload);

}  // namespace dance::wire
