// The beats of a music file without a list of them: found in advance, by the same tracker that a
// microphone uses, so that every house with that file (and the same hint, if any) has the same
// beats from its first second on.
//
// Units/frames: as producers/music/beat_grid.h; the bar is not known.
// Ownership:    plain values; leaves the file at its begin.
// Threads:      none inside; takes some hundredths of the music's length.
// Failure:      an Error where no steady beat is heard, or the file is damaged.
#pragma once

#include <atomic>

#include "core/base/result.h"
#include "producers/music/beat_grid.h"
#include "producers/music/decode/audio_file.h"
#include "producers/music/tracker/tempo/tempo_evidence.h"

namespace dance {

struct TrackedSong {
  BeatGrid grid;
  float confidence = 0.0f;  // mean, as core/base/beat.h
};

// The hint is of the whole song. Another thread may cancel it, which is an Error.
Result<TrackedSong> track_song(AudioFile& file, const TempoHint& hint = {},
                               const std::atomic<bool>* is_cancelled = nullptr);

}  // namespace dance
