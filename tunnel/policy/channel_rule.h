// One further channel of the bus that may ride along to the other houses, or be let in from them: a
// light desk, a robot arm. One line on the command line and in session files, as
// `ROBOT/arm class=newest size=256 rate=60 layout=i64,f64[7]`; docs/channels.md says each word.
//
// Units/frames: sizes in bytes, of whole messages with their fingerprint; rates in messages a
//               second.
// Ownership:    plain value; admits() allocates nothing.
// Threads:      none inside.
// Failure:      parse() names the rule, the word and the cure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/bus/channel_pattern.h"
#include "tunnel/policy/layout_check.h"

namespace dance {

// kState: the last message counts, and those who come later get it. kNewest: as poses, a lost one
// is made good by the next.
enum class ChannelClass : std::uint8_t { kState = 1, kNewest = 2 };

constexpr std::size_t kMaxChannelStateBytes = 400;
constexpr std::size_t kMaxChannelNewestBytes = 512;
constexpr double kMaxChannelRate_hz = 240.0;
constexpr double kMaxChannelStateRate_hz = 20.0;
// Rules of one house, and channels of one guest.
constexpr std::size_t kMaxChannelRules = 16;
constexpr std::size_t kMaxChannelsPerGuest = 8;

struct ChannelRule {
  ChannelPattern pattern;
  ChannelClass kind = ChannelClass::kState;
  std::size_t max_bytes = kMaxChannelStateBytes;
  double rate_hz = 0.0;
  bool is_out = true;  // from this house to the others
  bool is_in = true;   // from the others onto this house's bus
  LayoutCheck layout;
  GuestId guest;  // whose it is on the way out; not set: the house's first guest

  // "NAME key=value …"
  static Result<ChannelRule> parse(std::string_view line);
  // The same in parts, as a session file has them.
  using Words = std::vector<std::pair<std::string, std::string>>;
  static Result<ChannelRule> of(std::string_view name, const Words& words);

  // Whether a message of a channel that the pattern matches may pass, of whichever direction.
  bool admits(std::span<const std::uint8_t> message) const {
    return message.size() <= max_bytes && layout.accepts(message);
  }
};

// Of several options, one rule each; an error where there are more than kMaxChannelRules.
Result<std::vector<ChannelRule>> parse_channel_rules(const std::vector<std::string>& lines);

// The first rule that lets a channel out, or in; null where none does.
const ChannelRule* find_rule_out(std::span<const ChannelRule> rules, std::string_view name);
const ChannelRule* find_rule_in(std::span<const ChannelRule> rules, std::string_view name);
// Whether some channels are let in at all.
bool lets_any_in(std::span<const ChannelRule> rules);

}  // namespace dance
