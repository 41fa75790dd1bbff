// WindowChoices: the [window] of a session file: what only `dance lobby` needs. A house takes
// no notice of it, but an error in it is told like any other.
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

struct WindowChoices {
  static constexpr std::size_t kMostRooms = 32;
  static constexpr int kLeastWidth_px = 640, kLeastHeight_px = 480, kMost_px = 8192;

  std::string language;            // "en", "es", "de"; "" = as the system's
  std::vector<KnownRoom> rooms;    // the one used last comes first
  std::string partner = "follow";  // lead or follow, or a file
  std::string music;               // to practise with; "" = none
  bool mirror = true;              // practise before a mirror
  int width_px = 1280;
  int height_px = 720;
  bool operator==(const WindowChoices&) const = default;
};

// `folder` is the session file's: names of files are taken from there.
WindowChoices read_window(TomlReader& reader, const std::string& folder);

}  // namespace dance
