#include "haptics/haptic_control.h"

#include <fmt/format.h>
#include <unistd.h>

#include "core/bus/bus.h"

namespace dance {
namespace {

std::string haptics_path(const std::string& bus, const GuestId& guest) {
  return control_path("haptics", bus_url_or_default(bus), guest);
}

}  // namespace

std::optional<HapticCommand> parse_haptic_command(std::string_view text) {
  using Kind = HapticCommand::Kind;
  if (text == "on") return HapticCommand{Kind::kOn, 1.0f};
  if (text == "off") return HapticCommand{Kind::kOff, 1.0f};
  const auto limit = share_after("limit", text);
  if (!limit) return std::nullopt;
  return HapticCommand{Kind::kLimit, static_cast<float>(*limit)};
}

std::string text_of(const HapticCommand& command) {
  if (command.kind == HapticCommand::Kind::kLimit)
    return fmt::format("limit {:.4f}", command.limit);
  return command.kind == HapticCommand::Kind::kOn ? "on" : "off";
}

Result<std::unique_ptr<HapticControl>> HapticControl::open(const std::string& bus,
                                                           std::vector<HapticFeed*> feeds,
                                                           OnTold told, Poller& poller) {
  const GuestId guest = feeds.front()->guest();
  std::unique_ptr<HapticControl> control(new HapticControl(std::move(feeds), std::move(told)));
  const std::string path =
      numbered_control_path(haptics_path(bus, guest), static_cast<std::uint64_t>(getpid()));
  auto opened = ProgramControl::open(
      path, [raw = control.get()](std::string_view text, MonoTime) { raw->hear(text); }, poller);
  if (!opened)
    return fail("dance haptics set does not reach " + std::string(guest.view()) +
                " here: " + opened.error().what);
  control->control_ = std::move(*opened);
  return control;
}

void HapticControl::hear(std::string_view text) {
  const auto command = parse_haptic_command(text);
  if (!command) {
    ++refused_;
    return;
  }
  for (HapticFeed* feed : feeds_) {
    if (command->kind == HapticCommand::Kind::kLimit)
      feed->set_limit(command->limit);
    else
      feed->set_on(command->kind == HapticCommand::Kind::kOn);
  }
  if (!told_) return;
  const std::string_view guest = feeds_.front()->guest().view();
  if (command->kind == HapticCommand::Kind::kLimit)
    told_(fmt::format("{} feels nothing stronger than {:.2f}", guest, command->limit));
  else
    told_(fmt::format("{}: haptics are {}", guest, text_of(*command)));
}

Result<int> tell_haptics(const std::string& bus, const GuestId& guest,
                         const HapticCommand& command) {
  DANCE_TRY(const ToldAll told, tell_programs(haptics_path(bus, guest), text_of(command)));
  const std::string name(guest.view());
  if (told.deaf > 0) return fail("a program with haptics of " + name + " does not listen; end it");
  if (told.sent == 0)
    return fail("nothing runs that lets " + name +
                " feel on this bus: a house with [[haptics]], or dance haptics --guest " + name);
  return told.sent;
}

}  // namespace dance
