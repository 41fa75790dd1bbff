#include "producers/music/room/band_program.h"

#include <cmath>

#include "core/bus/voice.h"
#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "producers/music/room_music.h"

namespace dance {
namespace {

constexpr Duration kTurn = Duration::ms(10);
constexpr Duration kSecond = Duration::s(1);
// Share of the volume while a guest of another house speaks.
constexpr double kDucked = 0.4;
constexpr Duration kSpeechPause = Duration::ms(700);
constexpr int kSpeech_dbfs = -50;

}  // namespace

BandProgram::BandProgram(const BandRoom::Options& options, double volume, SignalPort& bus,
                         Poller& poller)
    : guest_(options.guest), volume_(volume), bus_(bus), room_(options, mono_now()) {
  publisher_ =
      std::make_unique<BeatPublisher>(bus_, poller, [this](MonoTime now) { return beat(now); });
  bus_.subscribe<RoomSong>(Where::kRoom,
                           [this](const Channel& channel, const RoomSong& song, MonoTime now) {
                             room_.on_room_song(channel.guest(), song, now);
                             follow_song(now);
                           });
  bus_.subscribe<Music>(Where::kRoom, [this](const Channel&, const Music& music, MonoTime now) {
    if (music.clock_id != this_clock_id()) return;
    room_music_ = music;
    room_.on_room_music(music, now);
  });
  bus_.subscribe<Voice>(Where::kGuest, [this](const Channel&, const Voice& voice, MonoTime now) {
    if (voice.level_dbfs > kSpeech_dbfs) spoken_ = now;
  });
  poller.add_timer(mono_now(), [this](MonoTime now) { return work(now); });
  poller.add_timer(mono_now() + kSecond, [this](MonoTime now) { return each_second(now); });
}

void BandProgram::apply(const MusicCommand& command) {
  const MonoTime now = mono_now();
  switch (command.what) {
    case MusicCommand::What::kVolume:
      volume_ = command.volume;
      break;
    case MusicCommand::What::kNext:
      room_.play_next(now);
      break;
    case MusicCommand::What::kPlay:
      room_.set_playing(true, now);
      break;
    case MusicCommand::What::kPause:
      room_.set_playing(false, now);
      break;
    case MusicCommand::What::kSlower:
    case MusicCommand::What::kFaster:
      room_.change_tempo(command.what == MusicCommand::What::kSlower ? -1 : 1, now);
      break;
    case MusicCommand::What::kLock:
    case MusicCommand::What::kUnlock:
      room_.set_locked(command.what == MusicCommand::What::kLock, now);
      break;
    case MusicCommand::What::kSpeed:
      return;  // the band changes its tempo instead
    case MusicCommand::What::kStyle:
      if (const auto style = band_style_of(command.style.view())) room_.play_style(*style, now);
      break;
  }
  publish_request();
  follow_song(now);
}

void BandProgram::publish_request() {
  if (!room_.request() || !guest_.is_set() || is_over_) return;
  RoomSong song = *room_.request();
  song.time = mono_now();
  bus_.publish(Channel::of(Signal::kSong, Where::kCapture, guest_), song);
}

// Starts, moves or pauses the player, as the song in force requires.
void BandProgram::follow_song(MonoTime now) {
  const bool plays = room_.plays(now) && !is_over_;
  if (!plays) {
    if (is_playing_) player_->pause();
    is_playing_ = false;
    played_.reset();
    return;
  }
  const RoomSong& song = *room_.song();
  const bool is_moved = !played_ || played_->start_time != song.start_time;
  if (!played_ || !is_same_song(*played_, song) || !is_playing_)
    talk::info(
        "{}, {} a minute", band_title(static_cast<BandStyle>(song.style)),
        std::lround(song.tempo_centi_bpm[static_cast<std::size_t>(song.tempo_count - 1)] * 0.01));
  if (is_moved || !is_playing_) player_->play_from(song.start_time, true);
  is_playing_ = true;
  played_ = song;
}

void BandProgram::set_gain(MonoTime now) {
  const bool is_spoken = spoken_.is_set() && now - spoken_ < kSpeechPause;
  player_->set_volume(volume_ * (is_spoken ? kDucked : 1.0));
}

MonoTime BandProgram::work(MonoTime now) {
  room_.set_has_other_music(publisher_->has_other_publisher(now));
  room_.work(now);
  if (room_.request() && (!published_ || !is_same_song(*published_, *room_.request()))) {
    published_ = room_.request();
    publish_request();
  }
  follow_song(now);
  set_gain(now);
  if (auto worked = player_->work(now); !worked) {
    talk::warn("{}; keeps the time without sound", worked.error().what);
    player_ = std::make_unique<SilentPlayer>();
    is_playing_ = false;
  }
  return now + kTurn;
}

MonoTime BandProgram::each_second(MonoTime now) {
  publish_request();
  return now + kSecond;
}

std::optional<Beat> BandProgram::beat(MonoTime now) {
  if (publisher_->has_other_publisher(now)) return std::nullopt;
  if (room_.has_other_music(now))
    return room_music_ ? std::optional(beat_of_room_music(*room_music_, now)) : std::nullopt;
  if (!room_.song()) return std::nullopt;
  // The session's time, which the player keeps to a millisecond: while a change of the song is on
  // its way through the sound server, the player's own position belongs to the song before.
  const double session_s = (now - room_.song()->start_time).as_seconds();
  if (room_.plays(now) && !is_over_)
    return player_->heard_s(now) ? std::optional(beat_of_set(session_s, now)) : std::nullopt;
  Beat stopped = beat_of_set(session_s, now);
  stopped.playing = false;
  stopped.beat_time = now;
  return stopped;
}

Beat BandProgram::beat_of_set(double set_s, MonoTime now) {
  const Song::NextBeat next = room_.set()->next_beat(set_s);
  Beat beat;
  beat.time = now;
  beat.clock_id = this_clock_id();
  beat.beat = next.beat;
  beat.beat_time = now + Duration::seconds(next.song_s - set_s);
  beat.tempo_bpm = next.tempo_bpm;
  beat.beats_per_bar = room_.set()->beats_per_bar();
  beat.confidence = 1.0f;
  beat.playing = true;
  // Before the first bar there is nothing to dance to.
  if (set_s < 0.0) {
    beat.playing = false;
    beat.beat = room_.set()->beat_at(0.0);
    beat.beat_time = now;
  }
  return beat;
}

void BandProgram::stop(MonoTime now) {
  const bool had_published = publisher_->published() > 0;
  is_over_ = true;
  player_->pause();
  if (had_published) publisher_->publish(now);
}

}  // namespace dance
