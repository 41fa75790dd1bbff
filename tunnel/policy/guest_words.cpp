#include "tunnel/policy/guest_words.h"

#include <algorithm>

namespace dance {

Result<GuestWords> parse_guest_words(std::span<const std::string> words,
                                     const GuestWordRule& rule) {
  GuestWords parsed;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string_view name = std::string_view(word).substr(0, equals);
    std::optional<std::uint8_t> value;
    if (equals != std::string::npos)
      value = rule.value_of(std::string_view(word).substr(equals + 1));
    if (!value) return fail("'" + word + "': " + rule.how);
    if (name == "default") {
      if (parsed.others) return fail("'" + word + "': default is given twice");
      parsed.others = value;
      continue;
    }
    const auto guest = GuestId::parse(name);
    if (!guest) return fail("'" + word + "': " + kGuestIdRule);
    if (std::any_of(parsed.guests.begin(), parsed.guests.end(),
                    [&](const auto& named) { return named.guest == *guest; }))
      return fail("'" + word + "': " + std::string(name) + " is given twice");
    if (!parsed.guests.try_push({*guest, *value}))
      return fail("'" + word + "': at most " + std::to_string(kMaxInterestGuests) +
                  " guests can be named; " + rule.others);
  }
  return parsed;
}

}  // namespace dance
