// A rule's line up to the first line break, and behind it the bytes of a message: whatever the
// reader takes is within its bounds, and the check ends.
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "tests/fuzz_target.h"
#include "tunnel/policy/channel_rule.h"

DANCE_FUZZ_TARGET(channel_rule) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\n'), size);
  const auto rule = dance::ChannelRule::parse(text.substr(0, end));
  if (!rule) {
    DANCE_ASSERT(!rule.error().what.empty());
    return 0;
  }
  DANCE_ASSERT(rule->max_bytes > 0 && rule->max_bytes <= dance::kMaxChannelNewestBytes);
  DANCE_ASSERT(rule->rate_hz > 0 && rule->rate_hz <= dance::kMaxChannelRate_hz);
  const std::span<const std::uint8_t> message(data + end, size - end);
  if (message.empty()) return 0;
  if (rule->admits(message.subspan(1))) DANCE_ASSERT(message.size() - 1 <= rule->max_bytes);
  return 0;
}
