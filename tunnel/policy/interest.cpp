#include "tunnel/policy/interest.h"

#include <charconv>

namespace dance {
namespace {

constexpr const char* kWantRule =
    ": write NAME=N or default=N, where N is 0 (nothing), 1 (every pose) or up to 255 (every N-th)";

}  // namespace

Result<Interest> parse_interest(std::span<const std::string> words) {
  Interest interest;
  bool has_default = false;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    unsigned divider = 256;
    if (equals != std::string::npos) {
      const char* end = word.data() + word.size();
      const auto read = std::from_chars(word.data() + equals + 1, end, divider);
      if (read.ec != std::errc() || read.ptr != end) divider = 256;
    }
    if (divider > 255) return fail("'" + word + "'" + kWantRule);
    const auto as_divider = static_cast<std::uint8_t>(divider);
    if (name == "default") {
      if (has_default) return fail("'" + word + "': default is given twice");
      has_default = true;
      interest.others = as_divider;
      continue;
    }
    const auto guest = GuestId::parse(name);
    if (!guest) return fail("'" + word + "': " + kGuestIdRule);
    for (const Interest::One& one : interest.guests)
      if (one.guest == *guest) return fail("'" + word + "': " + name + " is given twice");
    if (!interest.guests.try_push({*guest, as_divider}))
      return fail("'" + word + "': at most " + std::to_string(kMaxInterestGuests) +
                  " guests can be named; default=N is for all others");
  }
  return interest;
}

}  // namespace dance
