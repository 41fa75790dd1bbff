// A list of beats as somebody may write it: what is taken is in order, and number and seconds lead
// to each other.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "core/base/beat.h"
#include "producers/music/beats_file.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(beats_file) {
  const auto grid = dance::parse_beats(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!grid) {
    DANCE_ASSERT(!grid.error().what.empty());
    return 0;
  }
  DANCE_ASSERT(grid->size() >= 2 && grid->size() <= dance::BeatGrid::kMostBeats);
  const double step = static_cast<double>(grid->size()) / 16.0;
  double before_s = grid->time_of(grid->first_beat() - 1.0);
  for (double beat = grid->first_beat(); beat <= grid->last_beat() + 2.0; beat += step) {
    const double time_s = grid->time_of(beat);
    DANCE_ASSERT(time_s > before_s);
    DANCE_ASSERT(std::abs(grid->beat_at(time_s) - beat) < 1e-6);
    // The line through five beats may be a little beyond what one beat may.
    const double tempo_bpm = grid->tempo_bpm(beat);
    DANCE_ASSERT(tempo_bpm >= dance::kLeastTempo_bpm * 0.999 &&
                 tempo_bpm <= dance::kMostTempo_bpm * 1.001);
    before_s = time_s;
  }
  return 0;
}
