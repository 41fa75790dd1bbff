// SettingsFile: the session file that the window keeps: $XDG_CONFIG_HOME/dancegraph/house.toml.
// `dance join` takes it as it is, and a person may edit it meanwhile: each change is made to the
// text that lies there, whole, by a new file in the old one's place.
//
// Units/frames: none.
// Ownership:    the file of that name; one that is broken is renamed, never overwritten.
// Threads:      one owner.
// Failure:      open() and save() say what is wrong where, and under which name a broken file was
//               kept; a file that cannot be read or renamed is left alone, and an error.
#pragma once

#include <string>

#include "lobby/settings/lobby_settings.h"

namespace dance {

class SettingsFile {
 public:
  // Where it is: an error without HOME and XDG_CONFIG_HOME.
  static Result<std::string> usual_path();
  explicit SettingsFile(std::string path) : path_(std::move(path)) {}

  struct Opened {
    LobbySettings settings;
    std::string trouble;  // file, line and what is wrong; "" = nothing
    std::string kept_as;  // the broken file's new name; "" = none
    bool is_new = false;  // there was none: the settings are the first ones
  };
  Result<Opened> open();

  struct Saved {
    std::string trouble;  // of a file that somebody has broken since
    std::string kept_as;
  };
  Result<Saved> save(const LobbySettings& settings);

  // Settings that are tried before they are saved: a copy of the file with them, beside it, so that
  // relative names in it stay valid. Returns its path. A broken file is an error.
  Result<std::string> save_trial(const LobbySettings& settings) const;
  void remove_trial() const;

  const std::string& path() const { return path_; }

 private:
  std::string trial_path() const;
  // The file's text with these settings; `text` is its present text, "" if there is no file.
  Result<std::string> edited(std::string text, const LobbySettings& settings) const;
  // Renames what lies there; the new name.
  Result<std::string> keep_aside() const;

  std::string path_;
};

// A new dancer's: the name of the user, before a camera where there is one.
LobbySettings first_settings();

}  // namespace dance
