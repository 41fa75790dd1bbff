// Chat: a line of text, applause or a heart that a guest sends to the room. It has the fields of
// lcmtypes/chat_t.lcm, which documents each.
//
// Units/frames: MonoTime of the clock that clock_id names; characters are Unicode code points.
// Ownership:    plain values, no heap.
// Failure:      is_valid() is false for what the .lcm file does not allow, above all for lines with
//               characters that act on a display (core/base/text/plain_text.h).
#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/fixed_string.h"
#include "core/base/text/plain_text.h"
#include "core/base/time.h"

namespace dance {

enum class ChatKind : std::int8_t { kLine, kApplause, kHeart };

constexpr std::size_t kMaxChatCharacters = 200;
constexpr std::size_t kMaxChatBytes = 400;
using ChatText = FixedString<kMaxChatBytes>;

// A guest sends a line, and a sign, this often at most.
constexpr Duration kChatPeriod = Duration::s(1);

struct Chat {
  MonoTime time;  // when it was written
  std::uint64_t clock_id = 0;
  ChatKind kind = ChatKind::kLine;
  ChatText text;  // empty for applause and hearts

  bool is_line() const { return kind == ChatKind::kLine; }
};

// True for a line that may be shown: 1 to 200 characters, not only spaces, none of them hidden.
constexpr bool is_chat_line(std::string_view text) {
  if (text.size() > kMaxChatBytes || text.find_first_not_of(' ') == text.npos) return false;
  std::size_t characters = 0;
  for (; !text.empty(); ++characters) {
    const auto character = first_character(text);
    if (!character || is_hidden_character(character->code)) return false;
    text.remove_prefix(character->bytes);
  }
  return characters <= kMaxChatCharacters;
}

inline bool is_valid(const Chat& chat) {
  if (chat.is_line()) return is_chat_line(chat.text.view());
  return (chat.kind == ChatKind::kApplause || chat.kind == ChatKind::kHeart) && chat.text.empty();
}

}  // namespace dance
