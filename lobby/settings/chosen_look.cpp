#include "lobby/settings/chosen_look.h"

#include <array>
#include <cstdio>

#include "formats/body/look_names.h"

namespace dance {

GuestLook chosen_look(const LobbySettings& settings) {
  const GuestId guest = GuestId::parse(settings.name).value_or(GuestId());
  std::array<float, 3> colour{1.0f, 1.0f, 1.0f};
  if (!settings.colour.empty()) colour = parse_colour(settings.colour).value_or(colour);
  return named_look(guest, settings.look, colour).value_or(look_of(guest));
}

void choose_look(const GuestLook& look, LobbySettings& settings) {
  settings.look = name_of_look(look);
}

void choose_top(std::uint32_t rgb, LobbySettings& settings) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%06x", rgb & 0xffffffu);
  settings.colour = text.data();
}

}  // namespace dance
