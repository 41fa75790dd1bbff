// Which channels of the bus a rule speaks of: one name, as LIGHT/desk, or all that begin alike, as
// LIGHT/*. The one place that says what the channels besides our own signals may be called, and
// what they are called once they have come from another house: <channel>/guest/<guest>.
//
// Ownership: plain value; matching allocates nothing.
// Threads:   none inside.
// Failure:   parse() names the text and the cure.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/fixed_string.h"
#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/bus/channel.h"

namespace dance {

// What is left of LCM's limit beside "/guest/" and the longest guest.
constexpr std::size_t kMaxForeignName = kMaxChannelLength - 7 - kMaxGuestIdLength;
using ForeignName = FixedString<kMaxForeignName>;

// Whether a channel may ride along under this name: words of A-Z a-z 0-9 _ . - between slashes,
// none of our own signals in front, and no word "guest" in it, as what came from another house must
// not go out again.
bool is_foreign_name(std::string_view name);

// What `name` of that guest's house is called here. Panics (our bug) on a name that is not foreign.
FixedString<kMaxChannelLength> name_of_guest(std::string_view name, const GuestId& guest);

class ChannelPattern {
 public:
  ChannelPattern() = default;
  // A name, or a name's beginning and "*".
  static Result<ChannelPattern> parse(std::string_view text);

  bool matches(std::string_view name) const;
  std::string_view text() const { return text_.view(); }
  bool is_prefix() const { return is_prefix_; }

 private:
  FixedString<kMaxForeignName + 1> text_;
  bool is_prefix_ = false;
};

}  // namespace dance
