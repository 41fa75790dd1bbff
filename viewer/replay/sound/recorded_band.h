// RecordedBand: plays the house band of a recording again. The log holds the song, not its sound.
// The score is made again from the song, so that each frame has the samples of the recorded house.
//
// The band is silent while its song is paused, while other music plays in the room, and while the
// recorded beats are not those of the song.
//
// Units/frames: times of the recorded house's clock; stereo samples at kBandRate_hz are
//               interleaved.
// Ownership:    owns the songs and their sound.
// Failure:      songs of another clock, and songs that no band plays, are ignored. read() fails if
//               the soundfont cannot be read.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "core/base/beat.h"
#include "core/bus/channel.h"
#include "core/bus/state_messages.h"
#include "producers/music/room/band_source.h"

namespace dance {

class RecordedBand {
 public:
  // The block that read() fills.
  static constexpr std::size_t kBlock_frames = 480;

  RecordedBand(std::uint64_t clock_id, BandSound sound)
      : clock_id_(clock_id), sound_(std::move(sound)) {}

  // Handle messages in the order of the recording. `where` is kRoom for the song in force, and
  // kCapture for a request, which is in force if there is no room.
  void on_song(Where where, const RoomSong& song, MonoTime now);
  void on_music(const Music& music, MonoTime now);
  void on_beat(const Beat& beat, MonoTime now);

  // Fills a block that begins at `at`. Each call continues where the last block ended.
  Result<void> read(MonoTime at, std::span<float> stereo);

  // The styles that were played.
  const std::set<BandStyle>& heard() const { return heard_; }
  // The titles of other music, whose sound the recording does not have; at most kMostTitles.
  const std::set<std::string>& missing() const { return missing_; }
  // True if the recording has beats of music without a title.
  bool is_untitled_missing() const { return is_untitled_missing_; }

 private:
  static constexpr std::size_t kMostTitles = 3;
  // A song of a set, and how far a moment is from its start.
  struct Place {
    BandStyle style = BandStyle::kSalsa;
    std::uint32_t seed = 0;
    std::int64_t begin_frame = 0;  // minus the frame of the moment
  };

  bool plays(MonoTime at) const;
  bool is_song_wanted() const;
  bool continues(const RoomSong& song, MonoTime at);
  void note_missing(MonoTime at);

  std::uint64_t clock_id_;
  BandSound sound_;
  std::shared_ptr<BandSet> set_ = std::make_shared<BandSet>();
  std::unique_ptr<BandSource> source_;
  std::optional<RoomSong> wanted_, played_;  // the song in force, and that of set_
  BandSet wanted_set_;                       // compared with the recorded beats
  MonoTime room_received_;
  std::optional<Music> music_;
  MonoTime music_received_;
  std::optional<Beat> beat_;
  MonoTime unlike_since_;  // when the beats began to differ from the song's; not set: they match
  float gain_ = 0.0f;
  std::set<BandStyle> heard_;
  std::set<std::string> missing_;
  int untitled_blocks_ = 0;  // in a row
  bool is_untitled_missing_ = false;
};

}  // namespace dance
