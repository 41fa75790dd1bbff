// ChatBudget: limits one guest to a line a second and, separately, a sign a second. Bursts of
// kBurst are allowed, because a lapse of the path delays several, which then arrive together.
//
// Failure: take() returns false and changes nothing if the budget does not suffice.
#pragma once

#include "core/base/token_bucket.h"
#include "core/bus/chat.h"

namespace dance {

class ChatBudget {
 public:
  static constexpr std::size_t kBurst = 4;

  bool take(std::size_t lines, std::size_t signs, MonoTime now) {
    const auto as_tokens = [](std::size_t count) { return static_cast<double>(count); };
    if (lines_.level(now) < as_tokens(lines) || signs_.level(now) < as_tokens(signs)) return false;
    return lines_.take(as_tokens(lines), now) && signs_.take(as_tokens(signs), now);
  }
  bool take(const Chat& chat, MonoTime now) {
    return take(chat.is_line() ? 1 : 0, chat.is_line() ? 0 : 1, now);
  }

 private:
  static constexpr double kPerSecond = 1.0 / kChatPeriod.as_seconds();
  TokenBucket lines_{kPerSecond, kBurst};
  TokenBucket signs_{kPerSecond, kBurst};
};

}  // namespace dance
