// Words that give a value for each of some guests, and one for all others, as people write them:
// "alice=1", "default=0".
//
// Units/frames: values as their rule reads them.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      parse_guest_words() names the word that is wrong and how it is written.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tunnel/policy/interest.h"

namespace dance {

struct GuestWordRule {
  std::optional<std::uint8_t> (*value_of)(std::string_view text);
  const char* how;     // a word is written
  const char* others;  // what else to write where too many guests are named
};

struct GuestWords {
  struct Named {
    GuestId guest;
    std::uint8_t value = 0;
  };
  std::optional<std::uint8_t> others;  // of "default"
  FixedList<Named, kMaxInterestGuests> guests;
};

// Each guest, and "default", at most once.
Result<GuestWords> parse_guest_words(std::span<const std::string> words, const GuestWordRule& rule);

}  // namespace dance
