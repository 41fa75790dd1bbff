// What a session's text says of a guest of its own house: the shown name, the figure and the voice,
// and edits of these. The lobby's page You keeps them at the same places.
//
// Ownership: plain values.
// Failure:   an error names the file, and the guest whom the file does not name as its own; what is
//            edited is read again, so that what comes out is TOML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dance {

// [[avatar]] of a guest, as it is written.
struct OwnFigure {
  std::string what;    // a file's path, or the name of an avatar; "" = the mannequin
  std::string look;    // of the mannequin; "" = as the guest's id makes it
  std::string colour;  // "#e04080"; "" = the look's
  double height = 1.0;

  bool is_file() const { return what.find('/') != std::string::npos; }
  bool operator==(const OwnFigure&) const = default;
};

// Those of [house], the first one first.
Result<std::vector<std::string>> own_guests(std::string_view text, const std::string& name);

// A file's path is made absolute by the folder of `name`.
Result<OwnFigure> own_figure(std::string_view text, std::string_view guest,
                             const std::string& name);
Result<std::string> set_own_figure(std::string_view text, std::string_view guest,
                                   const OwnFigure& figure, const std::string& name);

// "" = the id is shown.
Result<std::string> set_own_name(std::string_view text, std::string_view guest,
                                 std::string_view shown_name, const std::string& name);

// An error where the file has no guest and no [voice].
Result<std::string> set_own_voice(std::string_view text, bool is_enabled, const std::string& name);

}  // namespace dance
