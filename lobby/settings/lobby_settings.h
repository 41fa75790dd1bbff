// LobbySettings: what a dancer has chosen in the window. Each field stands in the session file, as
// settings_of() reads it and edit_settings() writes it: there is no choice here that `dance join`
// would not find there.
//
// Units/frames: metres.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      edit_settings() names the file and the place, and the cure; its result has been
//               read again and holds what was wanted.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "house/session.h"

namespace dance {

// Who dances in this house: the [[produce]] of the first guest.
enum class DancerSource {
  kCamera,
  kHeadset,
  kFile,       // a recorded dance stands in
  kSynthetic,  // a made one does
  kElsewhere,  // another program or a device, or nobody: as the file says
};

struct LobbySettings {
  std::string name = "dancer";
  DancerSource source = DancerSource::kElsewhere;
  std::string camera;       // "" = the first
  double height_m = 0.0;    // 0 = not told
  std::string motion_file;  // of kFile
  bool leads = true;        // of kSynthetic
  std::string avatar;       // a name, a file, or words of a look; "" = the mannequin
  bool speaks = false;      // [voice]
  bool has_headphones = false;
  std::string microphone;   // "" = the default
  std::string loudspeaker;  // "" = the default
  std::string server;       // "" = none
  std::string room = "dance";
  WindowChoices window;
  bool operator==(const LobbySettings&) const = default;
};

// What of a house the window shows. Fields that do not count are as in LobbySettings().
LobbySettings settings_of(const HouseConfig& house);
// The same text with these choices; what the window does not know stays as it was written. `name`
// is the file's, from whose folder names of files in it are taken.
Result<std::string> edit_settings(std::string_view text, const LobbySettings& wanted,
                                  const std::string& name);
// Where fields do not count (the camera of one who dances from a file), as in LobbySettings().
LobbySettings only_what_counts(const LobbySettings& settings);
// Whether to write the later ones takes a table out of the file, with what else was written there
// by hand: not to be done while somebody may only be looking at the choices.
bool loses_a_table(const LobbySettings& written, const LobbySettings& later);

// A guest's name of whatever was typed: small letters, digits and '-'; "" where nothing is left.
std::string name_from(std::string_view typed);

}  // namespace dance
