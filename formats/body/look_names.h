// The names by which a guest chooses the mannequin's clothes and hair: words of one table joined by
// '-' in any order, as "dress-bun" or "flared-tail-long". What no word says stays as the guest's id
// makes it; "mannequin" alone leaves all of it so.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   nullopt for a name with another word, or with two words for the same thing.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "formats/body/guest_look.h"

namespace dance {

constexpr std::string_view kMannequinName = "mannequin";

// `colour` is linear RGB and tints the top (a dress whole, and the tag's colour follows); white
// keeps the look's own.
std::optional<GuestLook> named_look(const GuestId& guest, std::string_view name,
                                    const std::array<float, 3>& colour_rgb);

// Returns a word of each kind, so that only the colours of clothes depend on the guest's id. Skin
// and hair must be in the palettes.
std::string name_of_look(const GuestLook& look);

bool is_look_name(std::string_view name);
// For help and error messages: "legs trousers, flared or dress; hair …".
std::string look_names();

}  // namespace dance
