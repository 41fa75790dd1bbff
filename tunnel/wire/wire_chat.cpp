#include "tunnel/wire/wire_chat.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance::wire {
namespace {

constexpr std::size_t kHeaderBytes = 4 + 8;
constexpr std::size_t kEntryBytes = 2 + 1 + 2;
static_assert(kHeaderBytes + kEntryBytes + kMaxChatBytes <= kMaxStatePayload);

constexpr std::int64_t kOldest_ms = 65535;

bool read_entry(ByteReader& in, MonoTime newest, MonoTime later, Chat& chat) {
  chat.time = newest - Duration::ms(in.u16());
  chat.kind = static_cast<ChatKind>(in.u8());
  const std::size_t length = in.u16();
  return chat.text.assign(in.text(length)) && in.ok() && chat.time <= later && is_valid(chat);
}

}  // namespace

std::size_t build(const ChatHistory& history, std::span<std::uint8_t, kMaxStatePayload> buffer) {
  const auto& entries = history.entries;
  DANCE_ASSERT(!entries.empty());
  const MonoTime newest = entries[entries.size() - 1].time;
  ByteWriter out(buffer);
  out.u32(history.sequence);
  out.i64(newest.since_zero_us());
  std::int64_t age_ms = 0;  // never less than that of the later entry
  for (std::size_t i = entries.size(); i-- > 0;) {
    const Chat& chat = entries[i];
    const std::string_view text = chat.text.view();
    if (out.room() < kEntryBytes + text.size()) break;
    age_ms = std::clamp((newest - chat.time).count_us() / 1000, age_ms, kOldest_ms);
    out.u16(static_cast<std::uint16_t>(age_ms));
    out.u8(static_cast<std::uint8_t>(chat.kind));
    out.u16(static_cast<std::uint16_t>(text.size()));
    out.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  return out.size();
}

std::optional<ChatHistory> parse_chat(Bytes payload) {
  ByteReader in(payload);
  ChatHistory history;
  history.sequence = in.u32();
  const std::int64_t newest_us = in.i64();
  constexpr std::int64_t kCentury_us = 100LL * 366 * 24 * 3600 * 1'000'000;
  if (!in.ok() || newest_us <= -kCentury_us || newest_us >= kCentury_us) return std::nullopt;
  const MonoTime newest = MonoTime::from_us(newest_us);
  MonoTime later = newest;
  do {
    Chat chat;
    if (!read_entry(in, newest, later, chat) || !history.entries.try_push(chat))
      return std::nullopt;
    later = chat.time;
  } while (in.remaining() > 0);
  std::reverse(history.entries.begin(), history.entries.end());
  return history.entries[history.entries.size() - 1].time == newest ? std::optional(history)
                                                                    : std::nullopt;
}

}  // namespace dance::wire
