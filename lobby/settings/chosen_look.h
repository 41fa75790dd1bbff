// Converts between the settings and the mannequin's look, as all displays draw it.
//
// Units/frames: colours are linear RGB.
#pragma once

#include "formats/body/guest_look.h"
#include "lobby/settings/lobby_settings.h"

namespace dance {

// Invalid words and colours are ignored, the same as in displays.
GuestLook chosen_look(const LobbySettings& settings);
// Sets everything except the colours of clothes and shoes.
void choose_look(const GuestLook& look, LobbySettings& settings);
// `rgb` as 0xRRGGBB.
void choose_top(std::uint32_t rgb, LobbySettings& settings);

}  // namespace dance
