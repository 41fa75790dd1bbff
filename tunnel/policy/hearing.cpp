#include "tunnel/policy/hearing.h"

namespace dance {

Hearing both_of(const Hearing& one, const Hearing& other) {
  Hearing both;
  both.others = one.others && other.others;
  for (const Hearing* named : {&one, &other})
    for (const GuestId& guest : named->exceptions)
      if ((one.hears(guest) && other.hears(guest)) != both.others &&
          !both.exceptions.contains(guest))
        (void)both.exceptions.try_push(guest);
  return both;
}

Hearing either_of(const Hearing& one, const Hearing& other) {
  const auto not_of = [](Hearing hearing) {
    hearing.others = !hearing.others;
    return hearing;
  };
  return not_of(both_of(not_of(one), not_of(other)));
}

Result<Hearing> parse_hearing(std::span<const std::string> words) {
  constexpr const char* kRule = ": write NAME=1 (hear the guest), NAME=0 (do not) or default=0";
  FixedList<GuestId, kMaxInterestGuests> heard, muted;
  Hearing hearing;
  bool has_default = false;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
    if (value != "0" && value != "1") return fail("'" + word + "'" + kRule);
    if (name == "default") {
      if (has_default) return fail("'" + word + "': default is given twice");
      has_default = true;
      hearing.others = value == "1";
      continue;
    }
    const auto guest = GuestId::parse(name);
    if (!guest) return fail("'" + word + "': " + kGuestIdRule);
    if (heard.contains(*guest) || muted.contains(*guest))
      return fail("'" + word + "': " + name + " is given twice");
    if (!(value == "1" ? heard : muted).try_push(*guest))
      return fail("'" + word + "': at most " + std::to_string(kMaxInterestGuests) +
                  " guests can be named; default=0 is for all others");
  }
  hearing.exceptions = hearing.others ? muted : heard;
  return hearing;
}

}  // namespace dance
