#include "tunnel/policy/hearing.h"

#include "tunnel/policy/guest_words.h"

namespace dance {
namespace {

std::optional<std::uint8_t> yes_or_no_in(std::string_view text) {
  if (text != "0" && text != "1") return std::nullopt;
  return static_cast<std::uint8_t>(text == "1");
}

constexpr GuestWordRule kHearRule{yes_or_no_in,
                                  "write NAME=1 (hear the guest), NAME=0 (do not) or default=0",
                                  "default=0 is for all others"};

}  // namespace

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
  DANCE_TRY(const GuestWords parsed, parse_guest_words(words, kHearRule));
  Hearing hearing;
  if (parsed.others) hearing.others = *parsed.others == 1;
  for (const auto& [guest, value] : parsed.guests)
    if ((value == 1) != hearing.others) (void)hearing.exceptions.try_push(guest);
  return hearing;
}

}  // namespace dance
