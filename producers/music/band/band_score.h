// BandScore: all notes and beats of a BandSong. The same song has the same score on every machine:
// its arithmetic is in integers. A tempo change leaves all notes that begin before its bar as they
// were, and all frames before that bar sound the same.
//
// Units/frames: frames of the song, of 1/kBandRate_hz s. Notes and beats lie on multiples of
//               kBandBlock_frames, so that a beat of the grid is the frame of its notes.
// Failure:      make() requires a valid song (band_song.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "producers/music/band/band_note.h"
#include "producers/music/band/band_song.h"
#include "producers/music/band/compose/band_form.h"
#include "producers/music/beat_grid.h"

namespace dance {

// Some bars that are rendered together. No note begins or ends outside.
struct BandSection {
  int first_bar = 0;
  int bars = 0;  // at most kSection_bars
  BandPartKind part = BandPartKind::kVerse;
  std::int64_t begin_frame = 0;
  std::int64_t end_frame = 0;
  std::vector<BandNote> notes;  // in order of their begins
};

class BandScore {
 public:
  static constexpr int kSection_bars = 4;
  // The last notes ring on for this long after the last bar.
  static constexpr std::int64_t kTail_frames = std::int64_t{2} * kBandRate_hz;

  static BandScore make(const BandSong& song);
  // The begin of each bar and the end of the last, without composing the notes: at a hundredth of
  // the cost.
  static std::vector<std::int64_t> bar_begins(const BandSong& song);

  const BandSong& song() const { return song_; }
  const BeatGrid& grid() const { return grid_; }
  // The length of the song and its tail.
  std::int64_t length_frames() const { return bar_begins_.back() + kTail_frames; }

  int bars() const { return static_cast<int>(bar_begins_.size()) - 1; }
  std::int64_t bar_begin_frame(int bar) const;  // of 0 to bars(), which is the end
  // Before the song 0, after it the last.
  int bar_at(std::int64_t frame) const;

  std::span<const BandSection> sections() const { return sections_; }
  // Before the song the first section, after it the last.
  std::size_t section_at(std::int64_t frame) const;

 private:
  BandScore(const BandSong& song, BeatGrid grid);

  BandSong song_;
  BeatGrid grid_;
  std::vector<std::int64_t> bar_begins_;
  std::vector<BandSection> sections_;
};

}  // namespace dance
