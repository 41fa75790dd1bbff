#include "apps/crowd/crowd_plan.h"

#include <charconv>

#include "core/base/assert.h"

namespace dance {
namespace {

std::string numbered(const std::string& name, std::size_t number) {
  return name + "-" + std::to_string(number + 1);
}

}  // namespace

wire::RoomName CrowdPlan::room_name(std::size_t in_room) const {
  const auto parsed = wire::RoomName::parse(rooms == 1 ? room : numbered(room, in_room));
  DANCE_ASSERT(parsed.has_value());
  return *parsed;
}

GuestId CrowdPlan::guest_name(std::size_t place) const {
  const auto parsed = GuestId::parse(numbered(name, place));
  DANCE_ASSERT(parsed.has_value());
  return *parsed;
}

std::optional<std::size_t> CrowdPlan::place_of(const GuestId& guest) const {
  const std::string_view text = guest.view();
  if (text.size() < name.size() + 2 || text[name.size()] != '-' || !text.starts_with(name))
    return std::nullopt;
  const char* const begin = text.data() + name.size() + 1;
  const char* const end = text.data() + text.size();
  std::size_t number = 0;
  const auto read = std::from_chars(begin, end, number);
  if (*begin == '0' || read.ec != std::errc() || read.ptr != end || number == 0 ||
      number > guests_per_room())
    return std::nullopt;
  return number - 1;
}

Result<CrowdPlan> checked_plan(CrowdPlan plan) {
  const auto text = [](std::size_t n) { return std::to_string(n); };
  if (plan.rooms > plan.guests)
    return fail(text(plan.rooms) + " rooms for " + text(plan.guests) +
                " guests: some would be empty; raise --guests or lower --rooms");
  if (plan.guests_per_room() > wire::kMaxGuestsPerRoom)
    return fail("a room has at most " + text(wire::kMaxGuestsPerRoom) + " guests, and " +
                text(plan.guests) + " in " + text(plan.rooms) + " are " +
                text(plan.guests_per_room()) + " in one: raise --rooms or lower --guests");
  if (!wire::RoomName::parse(plan.rooms == 1 ? plan.room : numbered(plan.room, plan.rooms - 1)))
    return fail("--room '" + plan.room +
                "': a room's name is 1 to 24 characters of a-z, 0-9 and '-', with the number that "
                "follows where there are several");
  if (!GuestId::parse(numbered(plan.name, plan.guests_per_room() - 1)))
    return fail("--name '" + plan.name + "': with the number that follows, " + kGuestIdRule);
  if (plan.churn > plan.join_rate)
    return fail("--churn: guests who leave come back, not more a second than --join-rate");
  return plan;
}

}  // namespace dance
