#include "viewer/replay/sound/recorded_band.h"

#include <algorithm>
#include <cmath>

#include "producers/music/room/band_room.h"

namespace dance {
namespace {

// A link publishes the room's song and music once a second.
constexpr Duration kRoomTimeout = BandRoom::kRoomTimeout;
// A house that changes its song publishes the new beats within this time.
constexpr Duration kBeatsChange = Duration::ms(500);
constexpr Duration kBeatsTimeout = Duration::s(1);
// Beats that arrive shortly after the band has stopped are not other music.
constexpr int kUntitled_blocks = 50;
constexpr Duration kFurthestBeat = Duration::s(5);
constexpr double kSameBeat_beats = 0.25;
// Times are published in microseconds.
constexpr std::int64_t kSamePlace_frames = 2;

// The frame of a song at a moment, to the nearest.
std::int64_t frame_at(const RoomSong& song, MonoTime at) {
  constexpr std::int64_t kSixFrames_ns = 125'000;
  const std::int64_t scaled = 6 * (at - song.start_time).count_ns() + kSixFrames_ns / 2;
  return scaled / kSixFrames_ns - (scaled % kSixFrames_ns < 0 ? 1 : 0);
}

}  // namespace

void RecordedBand::on_song(Where where, const RoomSong& song, MonoTime now) {
  if (song.clock_id != clock_id_) return;
  if (now - song.start_time > BandRoom::kLongestSet) return;
  if (song.start_time - now > BandRoom::kFurthestStart) return;
  const bool has_room = room_received_.is_set() && now - room_received_ < kRoomTimeout;
  if (where == Where::kCapture && has_room) return;
  if (!wanted_set_.set(song)) return;
  if (where == Where::kRoom) room_received_ = now;
  wanted_ = song;
}

void RecordedBand::on_music(const Music& music, MonoTime now) {
  if (music.clock_id != clock_id_) return;
  music_ = music;
  music_received_ = now;
}

void RecordedBand::on_beat(const Beat& beat, MonoTime now) {
  if (beat.clock_id != clock_id_ || beat.beat_time - now > kFurthestBeat ||
      now - beat.beat_time > kFurthestBeat)
    return;
  beat_ = beat;
  const bool is_comparable = wanted_ && wanted_->playing && now >= wanted_->start_time &&
                             beat.beat_time >= wanted_->start_time;
  if (!is_comparable) {
    unlike_since_ = MonoTime();
    return;
  }
  const double expected = wanted_set_.beat_at((beat.beat_time - wanted_->start_time).as_seconds());
  const bool is_like = beat.playing && std::abs(beat.beat - expected) < kSameBeat_beats;
  if (is_like)
    unlike_since_ = MonoTime();
  else if (!unlike_since_.is_set())
    unlike_since_ = now;
}

bool RecordedBand::plays(MonoTime at) const {
  if (!wanted_ || !wanted_->playing) return false;
  // A log may have a gap of years behind its last song: frames that far away would overflow.
  if (at - wanted_->start_time > BandRoom::kLongestSet) return false;
  if (music_ && music_->playing && at - music_received_ < kRoomTimeout) return false;
  return !unlike_since_.is_set() || at - unlike_since_ < kBeatsChange;
}

bool RecordedBand::is_song_wanted() const {
  return played_ && wanted_ && is_same_song(*played_, *wanted_) &&
         played_->start_time == wanted_->start_time;
}

// True if a song has the same sound at that moment as the one that is played. That is so if only
// the tempo of a later bar has changed.
bool RecordedBand::continues(const RoomSong& song, MonoTime at) {
  const auto place = [&](BandSet& set, const RoomSong& of) {
    const std::int64_t frame = frame_at(of, at);
    const BandSet::Part& part = set.part_at(frame);
    return Place{part.song.style, part.song.seed, part.begin_frame - frame};
  };
  BandSet next;
  if (!next.set(song)) return false;
  const Place a = place(*set_, *played_), b = place(next, song);
  return a.style == b.style && a.seed == b.seed &&
         std::abs(a.begin_frame - b.begin_frame) <= kSamePlace_frames;
}

void RecordedBand::note_missing(MonoTime at) {
  const bool is_titled = music_ && music_->playing && at - music_received_ < kRoomTimeout;
  if (is_titled && !music_->title.view().empty()) {
    if (missing_.size() < kMostTitles) missing_.emplace(music_->title.view());
    return;
  }
  const bool has_beats = beat_ && beat_->playing && at - beat_->time < kBeatsTimeout;
  const bool is_of_band = wanted_ && wanted_->playing && !unlike_since_.is_set();
  untitled_blocks_ = is_titled || (has_beats && !is_of_band) ? untitled_blocks_ + 1 : 0;
  if (untitled_blocks_ == kUntitled_blocks) is_untitled_missing_ = true;
}

Result<void> RecordedBand::read(MonoTime at, std::span<float> stereo) {
  std::fill(stereo.begin(), stereo.end(), 0.0f);
  const bool is_to_play = plays(at);
  if (is_to_play)
    untitled_blocks_ = 0;
  else
    note_missing(at);
  // A song that does not continue the sound of the one before begins one block later: in this block
  // the old one fades out.
  if (is_to_play && !is_song_wanted() && (gain_ == 0.0f || !played_ || continues(*wanted_, at))) {
    set_->set(*wanted_);
    played_ = wanted_;
  }
  const float target = is_to_play && is_song_wanted() ? 1.0f : 0.0f;
  if (gain_ == 0.0f && target == 0.0f) return {};
  if (source_ == nullptr) {
    DANCE_TRY(source_, BandSource::make(set_, sound_));
  }
  const std::int64_t frame = frame_at(*played_, at);
  if (auto sounds = source_->read(frame, stereo); !sounds) return sounds;
  if (frame >= 0) heard_.insert(set_->part_at(frame).song.style);
  if (gain_ != target) {
    const float step = (target - gain_) / static_cast<float>(stereo.size() / 2);
    for (std::size_t i = 0; i < stereo.size(); ++i)
      stereo[i] *= gain_ + step * static_cast<float>(i / 2);
  }
  gain_ = target;
  return {};
}

}  // namespace dance
