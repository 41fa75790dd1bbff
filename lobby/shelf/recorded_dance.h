// RecordedDance: the facts about a recording that the list shows: time, length, guests and song.
//
// Units/frames: microseconds of the wall clock since 1970.
// Threads:      read_dance() takes as long as the disk for at most kMostRead_bytes.
// Failure:      facts that a damaged or hostile file does not give stay unknown.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/time.h"

namespace dance {

struct RecordedDance {
  static constexpr std::size_t kMostGuests = 16;

  std::string path;
  std::int64_t changed_us = 0;                     // last change of the file
  std::int64_t begun_us = 0;                       // first event; changed_us until the file is read
  Duration length;                                 // 0 = unknown
  std::vector<std::string> guests;                 // ids
  std::map<std::string, std::string> shown_names;  // of guests who have one
  std::string song;                                // "" = unknown
  double tempo_bpm = 0.0;                          // 0 = unknown
  bool is_read = false;                            // read_dance() was called
  bool has_motion = false;                         // a pose was found

  // The guest's shown name, else the id.
  const std::string& shown(const std::string& guest) const {
    const auto named = shown_names.find(guest);
    return named == shown_names.end() ? guest : named->second;
  }
  // The file's name without its ending, as people may see it.
  std::string name() const;
};

// Reads samples of the file: its beginning, its end and some places between them. Only a regular
// file is opened.
constexpr std::size_t kMostRead_bytes = std::size_t{640} << 10;
void read_dance(RecordedDance& dance);

}  // namespace dance
