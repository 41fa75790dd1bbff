// BandSet: the songs of the house band, one after the other without a break, made from the room's
// song: its fields name the first song, and each seed gives the next one. So all houses play the
// same songs at the same time, however late they join.
//
// Units/frames: frames at kBandRate_hz and seconds, from the first bar of the first song; beats
//               count on from song to song and through the rests between them.
// Ownership:    shares the scores of the last three songs that were read. The songs before them are
//               not composed, so that a room song that began a day ago costs no more.
// Failure:      set() is false for a song that no band plays, and changes nothing then.
#pragma once

#include <deque>
#include <memory>

#include "core/bus/state_messages.h"
#include "producers/music/band/band_score.h"
#include "producers/music/song.h"

namespace dance {

class BandSet {
 public:
  // Between two songs.
  static constexpr int kRest_bars = 2;

  struct Part {
    int number = 0;  // 0 is the first song
    BandSong song;
    std::shared_ptr<const BandScore> score;  // of part_at()
    std::int64_t begin_frame = 0;
    std::int64_t end_frame = 0;  // with the rest behind it
    double begin_beat = 0.0;
    double end_beat = 0.0;
  };

  bool set(const RoomSong& song);
  bool is_set() const { return !parts_.empty(); }
  // The song that holds this frame; before the first one, the first one.
  const Part& part_at(std::int64_t frame);

  double beat_at(double set_s);
  Song::NextBeat next_beat(double set_s);
  int beats_per_bar();

  // The same music from this song on, as a room song of its own. Its start is in the clock of
  // `begin`, the start of the set.
  RoomSong song_from(const Part& part, MonoTime begin) const;

 private:
  static constexpr std::size_t kMostParts = 3;
  // The last song of a set, which is silent after it: some days.
  static constexpr int kMostSongs = 1000;

  void append(const BandSong& song);

  RoomSong first_;
  std::deque<Part> parts_;  // consecutive
};

// "House band: salsa".
std::string band_title(BandStyle style);
std::uint32_t next_band_seed(std::uint32_t seed);
BandSong band_song_of(const RoomSong& song);

}  // namespace dance
