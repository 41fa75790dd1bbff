#include "core/control/role_control.h"

#include <array>

#include "core/bus/bus.h"

namespace dance {
namespace {

constexpr std::array<std::string_view, 3> kRoles{"any", "lead", "follow"};

std::string role_path(const std::string& bus, const GuestId& guest) {
  return control_path("role", bus_url_or_default(bus), guest);
}

}  // namespace

std::string_view name_of(DanceRole role) { return kRoles[static_cast<std::size_t>(role)]; }

std::optional<DanceRole> dance_role_of(std::string_view name) {
  for (std::size_t i = 0; i < kRoles.size(); ++i)
    if (kRoles[i] == name) return static_cast<DanceRole>(i);
  return std::nullopt;
}

Result<std::unique_ptr<ProgramControl>> open_role_control(const std::string& bus,
                                                          const GuestId& guest,
                                                          std::function<void(DanceRole)> on_role,
                                                          Poller& poller) {
  return ProgramControl::open(
      role_path(bus, guest),
      [on_role = std::move(on_role)](std::string_view line, MonoTime) {
        if (const auto role = dance_role_of(line)) on_role(*role);
      },
      poller);
}

bool has_role_control(const std::string& bus, const GuestId& guest) {
  return LocalDatagramSocket::is_served(role_path(bus, guest));
}

Result<void> send_role(const std::string& bus, const GuestId& guest, DanceRole role) {
  DANCE_TRY(const Told told, send_to_program(role_path(bus, guest), name_of(role)));
  const std::string name(guest.view());
  if (told == Told::kFull) return fail("the house of " + name + " is unresponsive; end it");
  if (told != Told::kSent) return fail("no house here has a synthetic dancer " + name);
  return {};
}

}  // namespace dance
