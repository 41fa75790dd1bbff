#include "producers/music/room/band_room.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// Old songs of the room may still arrive after a request.
constexpr Duration kOvertakes = Duration::ms(1500);
// Music that was not published for longer has ended.
constexpr Duration kOtherMusicTimeout = Duration::s(4);
constexpr Duration kFirstNotice = Duration::ms(500);

std::int32_t whole_bars(double beat, BandStyle style) {
  const double bar = beats_per_bar(style);
  return static_cast<std::int32_t>(
      std::clamp(std::ceil(beat / bar) * bar, 0.0, static_cast<double>(RoomSong::kLastBeat) - bar));
}

}  // namespace

BandRoom::BandRoom(const Options& options, MonoTime now) : options_(options), begun_(now) {}

bool BandRoom::adopt(const RoomSong& song) {
  if (song.clock_id != options_.clock_id || !set_->set(song)) return false;
  song_ = song;
  return true;
}

void BandRoom::on_room_song(const GuestId& setter, const RoomSong& song, MonoTime now) {
  const bool is_own = setter == options_.guest;
  if (!options_.follows && !is_own) return;
  if (now - song.start_time > kLongestSet || song.start_time - now > kFurthestStart) return;
  if (!adopt(song)) return;
  room_received_ = now;
  // After a restart of this program the room may still play the song that it requested.
  if (is_own && now - requested_ > kOvertakes) request_ = song;
  if (!is_own && request_ && now - requested_ > kOvertakes) request_.reset();
}

void BandRoom::on_room_music(const Music& music, MonoTime now) {
  if (options_.follows) room_music_until_ = music.playing ? now + kOtherMusicTimeout : MonoTime();
}

// A late joiner composes every song since the start: the setter moves the start on.
void BandRoom::renew(MonoTime now) {
  if (!request_ || !song_->playing || !is_same_song(*request_, *song_)) return;
  const BandSet::Part part = part_now(now);
  if (part.number >= kRenewedAfter_songs)
    make_request(set_->song_from(part, song_->start_time), now);
}

void BandRoom::work(MonoTime now) {
  if (song_) return renew(now);
  if (has_other_music(now) || (options_.follows && now - begun_ < kRoomTimeout)) return;
  const int bpm = options_.tempo_bpm > 0 ? options_.tempo_bpm : usual_tempo_bpm(options_.style);
  const Duration notice = options_.follows ? kNotice : kFirstNotice;
  make_request(song_at(now + notice, options_.style, options_.seed, 100 * bpm), now);
}

// A request takes effect at once if no room can accept it.
void BandRoom::make_request(const RoomSong& song, MonoTime now) {
  request_ = song;
  requested_ = now;
  const bool has_room =
      options_.follows && room_received_.is_set() && now - room_received_ < kRoomTimeout;
  if (!has_room) adopt(song);
}

RoomSong BandRoom::song_at(MonoTime start, BandStyle style, std::uint32_t seed,
                           std::int32_t centi_bpm) {
  RoomSong song;
  song.clock_id = options_.clock_id;
  song.start_time = start;
  if (song_) song.start_beat = whole_bars(set_->beat_at(song_s(start)), style);
  song.style = static_cast<int>(style);
  song.seed = seed;
  song.playing = true;
  song.locked = song_ && song_->locked;
  song.tempo_centi_bpm[0] = centi_bpm;
  return song;
}

const BandSet::Part& BandRoom::part_now(MonoTime now) {
  return set_->part_at(static_cast<std::int64_t>(std::floor(song_s(now) * kBandRate_hz)));
}

void BandRoom::play_next(MonoTime now) {
  if (!song_) return;
  const BandSong& band = part_now(now).song;
  make_request(song_at(now + kNotice, band.style, next_band_seed(band.seed),
                       band.tempi[band.tempi.size() - 1].centi_bpm),
               now);
}

void BandRoom::play_style(BandStyle style, MonoTime now) {
  const std::uint32_t seed = song_ ? next_band_seed(song_->seed) : options_.seed;
  make_request(song_at(now + kNotice, style, seed, 100 * usual_tempo_bpm(style)), now);
}

bool BandRoom::change_tempo(int steps, MonoTime now) {
  if (!song_) return false;
  const BandSet::Part part = part_now(now + kNotice);
  const std::int64_t known_frame =
      static_cast<std::int64_t>(song_s(now + kNotice) * kBandRate_hz) - part.begin_frame;
  const std::int32_t bar = known_frame < 0 ? 0 : part.score->bar_at(known_frame) + 1;
  RoomSong song = set_->song_from(part, song_->start_time);
  // Clicks add up before the room has accepted the first.
  if (request_ && request_->seed == song.seed && request_->start_beat == song.start_beat) {
    song = *request_;
    song.playing = true;
  }
  // Changes at later bars are dropped.
  int count = song.tempo_count;
  const double now_centi_bpm = song.tempo_centi_bpm[static_cast<std::size_t>(count - 1)];
  while (count > 1 && song.tempo_bar[static_cast<std::size_t>(count - 1)] >= bar) --count;
  if (bar == 0) count = 0;
  if (count == RoomSong::kMostTempi) return false;
  const double usual = 100.0 * usual_tempo_bpm(static_cast<BandStyle>(song.style));
  const double wanted =
      std::clamp(now_centi_bpm + steps * kTempoStep * usual, kSlowest * usual, kFastest * usual);
  if (std::lround(wanted) == std::lround(now_centi_bpm)) return false;
  song.tempo_bar[static_cast<std::size_t>(count)] = bar;
  song.tempo_centi_bpm[static_cast<std::size_t>(count)] =
      static_cast<std::int32_t>(std::lround(wanted));
  song.tempo_count = count + 1;
  for (int i = song.tempo_count; i < RoomSong::kMostTempi; ++i)
    song.tempo_bar[static_cast<std::size_t>(i)] =
        song.tempo_centi_bpm[static_cast<std::size_t>(i)] = 0;
  make_request(song, now);
  return true;
}

void BandRoom::set_playing(bool plays, MonoTime now) {
  if (!song_ || song_->playing == plays) return;
  const BandSong& band = part_now(now).song;
  RoomSong song = plays ? song_at(now + kNotice, band.style, band.seed,
                                  band.tempi[band.tempi.size() - 1].centi_bpm)
                        : *song_;
  song.playing = plays;
  make_request(song, now);
}

void BandRoom::set_locked(bool is_locked, MonoTime now) {
  if (!song_ || song_->locked == is_locked) return;
  RoomSong song = *song_;
  song.locked = is_locked;
  make_request(song, now);
}

}  // namespace dance
