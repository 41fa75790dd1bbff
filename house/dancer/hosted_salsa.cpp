#include "house/dancer/hosted_salsa.h"

#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

std::optional<SalsaRole> salsa_role_of(DanceRole role) {
  if (role == DanceRole::kEither) return std::nullopt;
  return role == DanceRole::kLead ? SalsaRole::kLead : SalsaRole::kFollow;
}

}  // namespace

Result<std::unique_ptr<PlacedSalsa>> make_salsa(const HostedProducer& producer,
                                                const BeatClock& music, MonoTime start) {
  const auto chosen = salsa_role_of(dance_role_of(producer.role).value_or(DanceRole::kEither));
  SalsaStyle style;
  style.role = chosen.value_or(SalsaRole::kLead);
  style.tempo_bpm = producer.tempo_bpm;
  style.seed = static_cast<std::uint64_t>(producer.seed);
  DANCE_TRY(const SalsaStyle checked, checked_style(style));
  SalsaDancer dancer(checked);
  dancer.listen_to(music, start);
  return std::make_unique<PlacedSalsa>(std::move(dancer),
                                       FloorSpots(producer.guest, chosen, mono_now()), start);
}

std::unique_ptr<ProgramControl> open_role_control_of(PlacedSalsa& salsa, const GuestId& guest,
                                                     const std::string& bus, Poller& poller) {
  auto control = open_role_control(
      bus, guest, [&salsa](DanceRole role) { salsa.choose_role(salsa_role_of(role)); }, poller);
  if (control) return std::move(*control);
  talk::warn("the role of {} cannot be changed: {}", guest.view(), control.error().what);
  return nullptr;
}

}  // namespace dance
