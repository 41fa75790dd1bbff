// Reads and edits the shown name, the figure and the voice of a guest in the text of a house file.
// The lobby's page You keeps them under the same keys.
//
// Failure:   an error names the file, and a guest who is not of this house. Each edited text is
//            parsed again, so that only valid TOML is returned.
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
