// WindowChoices: the [window] table of a session file, which only the window of dancers needs. A
// house ignores it except for the place; an error in it is reported like any other.
//
// Units/frames: pixels.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      read_window() complains in the reader, with file, line and column.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/guest_id.h"
#include "house/toml_reader.h"

namespace dance {

// A room of a server that the dancer has been in or is invited to: "salsa@example.org:7400".
struct KnownRoom {
  std::string room;
  std::string server;
  bool operator==(const KnownRoom&) const = default;

  std::string text() const { return room + "@" + server; }
  static std::optional<KnownRoom> parse(std::string_view text);
};

// Stands for no band where a style of the house band is named.
constexpr std::string_view kNoBand = "none";

struct WindowChoices {
  static constexpr std::size_t kMostRooms = 32;
  static constexpr int kLeastWidth_px = 640, kLeastHeight_px = 480, kMost_px = 8192;
  static constexpr double kSmallestLetters = 0.75, kLargestLetters = 2.5;

  std::string language;            // "en", "es", "de"; "" = as the system's
  std::vector<KnownRoom> rooms;    // the one used last comes first
  std::string partner = "follow";  // lead or follow, or a file
  std::string band = "salsa";      // style of the house band, or "none"
  std::string music;               // to practise with; "" = the band
  bool mirror = true;              // practise before a mirror
  std::string teacher;             // a recording to practise beside; "" = none
  std::string place = "studio";    // one of the names in viewer/scene/place.h
  double letters = 1.0;            // size of letters, times the usual one
  // The window with its frame and a task bar fits a screen of 1366 by 768.
  int width_px = 1200;
  int height_px = 640;
  bool operator==(const WindowChoices&) const = default;
};

// `folder` is the session file's: names of files are taken from there.
WindowChoices read_window(TomlReader& reader, const std::string& folder);

}  // namespace dance
