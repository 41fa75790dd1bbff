#include "tunnel/policy/interest.h"

#include <charconv>

#include "tunnel/policy/guest_words.h"

namespace dance {
namespace {

std::optional<std::uint8_t> divider_in(std::string_view text) {
  std::uint8_t divider = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, divider);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return divider;
}

constexpr GuestWordRule kWantRule{
    divider_in,
    "write NAME=N or default=N, where N is 0 (nothing), 1 (every pose) or up to 255 (every N-th)",
    "default=N is for all others"};

}  // namespace

Result<Interest> parse_interest(std::span<const std::string> words) {
  DANCE_TRY(const GuestWords parsed, parse_guest_words(words, kWantRule));
  Interest interest;
  interest.others = parsed.others.value_or(interest.others);
  for (const auto& [guest, divider] : parsed.guests)
    (void)interest.guests.try_push({guest, divider});
  return interest;
}

}  // namespace dance
