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
  kWatch,      // nobody: the guest only watches
  kElsewhere,  // another program or a device, or nobody: as the file says
};

struct LobbySettings {
  std::string name = "dancer";  // the id, to which keys belong
  std::string shown_name;       // the name that others see; "" = the id
  DancerSource source = DancerSource::kElsewhere;
  std::string camera;          // "" = the first
  double height_m = 0.0;       // 0 = unknown
  std::string motion_file;     // of kFile
  std::string role = "any";    // of kSynthetic: any, lead or follow
  std::string avatar;          // a name or a file; "" = the mannequin
  std::string look;            // words of the mannequin's look; "" = derived from the id
  std::string colour;          // of the mannequin's clothes, "#e04080"; "" = the look's
  double figure_height = 1.0;  // relative to the dancer's height
  bool speaks = false;         // [voice]
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

// Makes a guest's id from typed text: small letters, digits and '-'; "" if nothing is left.
std::string name_from(std::string_view typed);
// Another id that the same key allows, such as "ana-2"; the same id if that would be too long.
std::string further_name(const std::string& name);

}  // namespace dance
