// What a person writes to choose an avatar (a file, the name of one that ships with the program, or
// a look of the mannequin), and the messages that say so on the bus. A file is read and checked
// here, and a copy of it kept in this user's store, where link and displays find it by its hash.
//
// Units/frames: colours are written as a screen shows them and said linear; heights are times the
//               dancer's own.
// Ownership:    plain values.
// Threads:      none inside; takes tens of milliseconds.
// Failure:      says what is wrong with the file or the name, and what there is.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/bus/state_messages.h"
#include "core/store/avatar_store.h"

namespace dance {

struct AvatarChoice {
  std::string what;    // a file, a shipped avatar's name, mannequin, or words of a look
  std::string look;    // of the mannequin; "" = as the guest's name makes it
  std::string colour;  // "#e04080"; "" = the look's own
  double height = 1.0;
};

struct ChosenAvatar {
  Avatar avatar;
  AvatarFile file;
  std::vector<std::string> notes;  // what of the file is left out, for people
};

// `shipped_folder` has the avatars that come with the program.
Result<ChosenAvatar> choose_avatar(const AvatarChoice& choice, const AvatarStore& store,
                                   const std::string& shipped_folder);

// "#e04080", as a screen shows it → linear RGB.
Result<std::array<float, 3>> parse_colour(const std::string& text);

// "alice=me.vrm" → alice and me.vrm; without a guest before '=' the whole text, and no guest.
struct AvatarOfGuest {
  GuestId guest;
  std::string what;
};
AvatarOfGuest parse_avatar_of_guest(const std::string& text);

}  // namespace dance
