// Reads .beats files: one beat a line, its seconds, a TAB, its position in the bar from 1. Empty
// lines and lines that begin with # are skipped; a position may be missing in all of them where the
// bar is not known.
//
// Units/frames: seconds from the begin of the music.
// Ownership:    plain values.
// Threads:      none inside; reads the file on the caller's thread.
// Failure:      an Error names the file, the line and the cure. More than 4 MiB is refused.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "producers/music/beat_grid.h"

namespace dance {

Result<BeatGrid> parse_beats(std::string_view text);
Result<BeatGrid> read_beats_file(const std::string& path);

// Where the beats of a file of music stand: song.ogg has song.beats beside it.
std::string beats_path_beside(const std::string& music_path);

}  // namespace dance
