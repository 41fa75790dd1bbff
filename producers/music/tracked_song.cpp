#include "producers/music/tracked_song.h"

#include <vector>

#include "producers/music/tracker/beat_tracker.h"

namespace dance {
namespace {

constexpr std::size_t kFewestTrackedBeats = 8;

}  // namespace

Result<TrackedSong> track_song(AudioFile& file, const TempoHint& hint,
                               const std::atomic<bool>* is_cancelled) {
  if (file.rate_hz() < BeatTracker::kLeastRate_hz || file.rate_hz() > BeatTracker::kMostRate_hz)
    return fail(file.path() + ": no beats can be heard at " +
                std::to_string(static_cast<int>(file.rate_hz())) +
                " samples a second; convert it to 44100");
  BeatTracker tracker(file.rate_hz());
  tracker.set_tempo_hint(hint);
  std::vector<float> hop(tracker.hop_samples());
  std::vector<GridBeat> beats;
  double confidence = 0.0;
  Beat next;  // as last predicted
  for (;;) {
    if (is_cancelled && *is_cancelled)
      return fail(file.path() + ": ended while its beats were sought");
    DANCE_TRY(const std::size_t read, file.read(hop));
    if (read == 0) break;
    tracker.push(std::span(hop).first(read));
    const Beat& beat = tracker.beat();
    if (next.playing && beat.beat > next.beat && beats.size() < BeatGrid::kMostBeats) {
      beats.push_back({(next.beat_time - MonoTime()).as_seconds(), 0});
      confidence += static_cast<double>(next.confidence);
    }
    const bool has_begun = next.playing || beat.playing;
    next = beat;
    // In a pause the phase lock goes on, and so do the beats.
    next.playing = has_begun;
  }
  if (auto back = file.seek(0); !back) return tl::make_unexpected(back.error());
  if (beats.size() < kFewestTrackedBeats)
    return fail(file.path() + ": no steady beat is heard in it");
  DANCE_TRY(BeatGrid grid, BeatGrid::make(beats));
  return TrackedSong{std::move(grid),
                     static_cast<float>(confidence / static_cast<double>(beats.size()))};
}

}  // namespace dance
