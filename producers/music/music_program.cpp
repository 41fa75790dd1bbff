#include "producers/music/music_program.h"

#include <algorithm>
#include <cmath>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kPlayerTurn = Duration::ms(10);
constexpr Duration kMusicSecond = Duration::s(1);
// A link publishes the room's music once a second.
constexpr Duration kRoomTimeout = Duration::ms(3500);
constexpr Duration kNever = Duration::s(1LL << 32);
// About how long a change of speed takes to be heard.
constexpr Duration kHeardAfter = Duration::ms(300);
// The player's own position may belong to the speed before for so long.
constexpr Duration kSettled = Duration::s(1);
// Music that was not heard of for longer has ended.
constexpr Duration kRoomMusicTimeout = Duration::s(4);

}  // namespace

MusicProgram::MusicProgram(MusicProgramOptions options, std::unique_ptr<MusicPlayer> player,
                           SignalPort& bus, Poller& poller)
    : options_(std::move(options)),
      player_(std::move(player)),
      bus_(bus),
      poller_(poller),
      room_music_(options_.title, this_clock_id()) {
  const MonoTime now = mono_now();
  publisher_ =
      std::make_unique<BeatPublisher>(bus_, poller_, [this](MonoTime t) { return beat(t); });
  if (!options_.is_alone && (options_.follows || options_.guest.is_set()))
    bus_.subscribe<Music>(Where::kRoom,
                          [this](const Channel& channel, const Music& music, MonoTime t) {
                            if (music.clock_id == this_clock_id())
                              on_room_music(channel.guest(), music, t);
                          });
  wait_until_ = now + kRoomTimeout;
  if (options_.awaits_song) {
    state_ = State::kFinds;
    begin_ = options_.begin;
    if (options_.is_alone) play();
  } else if (!options_.follows) {
    begin_own(now);
  }
  poller_.add_timer(now, [this](MonoTime t) { return work(t); });
  poller_.add_timer(now, [this](MonoTime t) { return each_second(t); });
}

void MusicProgram::begin_own(MonoTime now) {
  begin_ = options_.begin.is_set() ? options_.begin : now;
  is_leader_ = options_.guest.is_set() && !options_.is_alone;
  state_ = State::kPlays;
  play();
}

// A song that another house leads ends when that house ends it.
void MusicProgram::play() {
  const bool loops = options_.loops || (state_ == State::kFollows && !is_leader_);
  if (options_.song) options_.song->set_loops(loops);
  player_->play_from(begin_, loops);
}

void MusicProgram::set_song(Song song, float confidence, MonoTime begin, MonoTime now) {
  if (state_ == State::kStopped && !is_paused_) return;
  options_.song.emplace(std::move(song));
  options_.confidence = confidence;
  options_.song->set_loops(options_.loops);
  if (options_.is_alone) {
    stopped_at_beats_ = options_.song->beat_at(std::max(0.0, paused_at_s_) / speed_);
    state_ = is_paused_ ? State::kStopped : State::kPlays;
    return publish_title(now);
  }
  options_.begin = begin;
  state_ = State::kWaits;
  wait_until_ = now + kRoomTimeout;
  if (!options_.follows)
    begin_own(now);
  else if (room_ && now - room_->time < kRoomMusicTimeout)
    on_room_music(room_setter_, *room_, now);
}

// Returns the position in the file that is heard now, or at which it was stopped.
double MusicProgram::file_s(MonoTime now) const {
  return is_paused_ ? paused_at_s_ : (now - begin_).as_seconds() * speed_;
}

void MusicProgram::set_playing(bool plays, MonoTime now) {
  if (plays != is_paused_ || (state_ == State::kStopped && !is_paused_)) return;
  before_.reset();
  if (plays) {
    begin_ = now + kHeardAfter - Duration::seconds(paused_at_s_ / speed_);
    is_paused_ = false;
    state_ = options_.song ? State::kPlays : State::kFinds;
    play();
  } else {
    paused_at_s_ = std::max(0.0, file_s(now));
    is_paused_ = true;
    player_->pause();
    if (options_.song) {
      stopped_at_beats_ = options_.song->beat_at(paused_at_s_ / speed_);
      state_ = State::kStopped;
    }
  }
  publisher_->publish(now);
  publish_title(now);
}

void MusicProgram::set_speed(double speed, MonoTime now) {
  if (speed == speed_ || (state_ == State::kStopped && !is_paused_)) return;
  const MonoTime heard = now + kHeardAfter;
  const double at_s = file_s(heard);
  if (!is_paused_ && options_.song) before_.emplace(Before{*options_.song, begin_, heard});
  speed_ = speed;
  if (options_.song) options_.song->set_speed(speed);
  player_->set_speed(speed);
  if (is_paused_) return;
  // A song that has not begun begins when it was to.
  if (at_s > 0.0) begin_ = heard - Duration::seconds(at_s / speed);
  play();
  publish_title(now);
}

void MusicProgram::begin_next(std::unique_ptr<MusicPlayer> player, const MusicTitle& title,
                              MonoTime begin) {
  if (state_ == State::kStopped && !is_paused_) return;
  const MonoTime now = mono_now();
  if (state_ == State::kPlays) set_playing(false, now);  // the beats stop, too
  player_ = std::move(player);
  options_.song.reset();
  options_.title = title;
  room_music_ = RoomMusic(title, this_clock_id());
  before_.reset();
  is_paused_ = false;
  paused_at_s_ = 0.0;
  begin_ = begin;
  state_ = State::kFinds;
  play();
  publish_title(now);
}

void MusicProgram::on_room_music(const GuestId& setter, const Music& music, MonoTime now) {
  room_ = music;
  room_setter_ = setter;
  if (state_ == State::kFinds) return;
  const bool is_ours = setter == options_.guest;
  if (is_ours && is_leader_) return;
  if (is_leader_ && state_ == State::kPlays) {
    is_leader_ = false;
    talk::info("the music in the room is {}'s now{}", setter.view(),
               options_.follows ? "" : "; this house plays on for itself (--follow joins theirs)");
  }
  if (options_.follows && state_ != State::kStopped) follow(setter, music, now);
}

void MusicProgram::follow(const GuestId& setter, const Music& music, MonoTime now) {
  const bool is_this_song = options_.song && music.title == options_.title;
  if (!music.playing) {
    if (state_ != State::kWaits) wait_for_room(now);
    return;
  }
  if (!is_this_song) {
    if (state_ != State::kKeepsRoomTime && options_.song)
      talk::warn("the room plays '{}' and this file is '{}': keeps the room's time without sound",
                 music.title.view(), options_.title.view());
    if (state_ != State::kKeepsRoomTime && !options_.song)
      talk::info("keeps the time of '{}', which {} plays", music.title.view(), setter.view());
    state_ = State::kKeepsRoomTime;
    player_->pause();
    return;
  }
  const bool is_ours = setter == options_.guest;
  options_.song->set_loops(options_.loops || !is_ours);
  const MonoTime begin = begin_of_room_music(music, *options_.song);
  // A song whose leader left without ending it is over.
  if (options_.song->is_over((now - begin).as_seconds()) && state_ == State::kWaits) return;
  if (state_ != State::kFollows)
    talk::info("joins '{}', which {} plays, at {:.1f} s", music.title.view(), setter.view(),
               std::max(0.0, (now - begin).as_seconds()));
  state_ = State::kFollows;
  // This guest's own song, from before a restart of this program: it leads again.
  is_leader_ = is_ours;
  begin_ = begin;
  play();
}

// Only the house that stopped the music starts it again.
void MusicProgram::wait_for_room(MonoTime now) {
  talk::info("the room's music has stopped; Ctrl-C ends this");
  stop(now);
  state_ = State::kWaits;
  wait_until_ = now + kNever;
}

MonoTime MusicProgram::work(MonoTime now) {
  if (auto worked = player_->work(now); !worked) {
    talk::warn("{}; keeps the time without sound", worked.error().what);
    player_ = std::make_unique<SilentPlayer>();
    player_->set_speed(speed_);
    const bool is_heard = options_.is_alone && state_ == State::kFinds && !is_paused_;
    if (is_heard || state_ == State::kPlays || state_ == State::kFollows) play();
  }
  if (state_ == State::kWaits && options_.song && now >= wait_until_) {
    talk::info("the room has no music: begins '{}'", options_.title.view());
    options_.begin = now + Duration::ms(500);
    begin_own(now);
  }
  const bool is_song = state_ == State::kPlays || state_ == State::kFollows;
  if (is_song && options_.song->is_over((now - begin_).as_seconds())) {
    stop(now);
    is_over_ = true;
    poller_.stop();
  }
  return now + kPlayerTurn;
}

// For the windows of a house that is alone. While the song is heard and its beats are not known,
// the tempo is unknown, and no beats are published.
void MusicProgram::publish_title(MonoTime now) {
  if (!options_.is_alone || !options_.guest.is_set()) return;
  Music music;
  if (state_ == State::kPlays) {
    music = room_music_.update(*options_.song, begin_, now);
  } else if (state_ == State::kFinds && !is_paused_) {
    music.time = now;
    music.clock_id = this_clock_id();
    music.start_time = begin_;
    music.playing = true;
    music.title = options_.title;
  } else {
    music = room_music_.update_stopped(stopped_at_beats_, now);
  }
  bus_.publish(Channel::of(Signal::kMusic, Where::kCapture, options_.guest), music);
}

MonoTime MusicProgram::each_second(MonoTime now) {
  publish_title(now);
  if (is_leader_ && (state_ == State::kPlays || state_ == State::kFollows))
    bus_.publish(Channel::of(Signal::kMusic, Where::kCapture, options_.guest),
                 room_music_.update(*options_.song, begin_, now));
  const bool has_other_publisher = publisher_->has_other_publisher(now);
  if (has_other_publisher && !warned_of_another_) talk::warn("{}", kAnotherPublisher);
  warned_of_another_ = has_other_publisher;
  return now + kMusicSecond;
}

std::optional<Beat> MusicProgram::beat(MonoTime now) const {
  switch (state_) {
    case State::kFinds:
    case State::kWaits:
      return std::nullopt;
    case State::kKeepsRoomTime:
      if (!room_ || now - room_->time > kRoomMusicTimeout) return std::nullopt;
      return beat_of_room_music(*room_, now);
    case State::kPlays:
    case State::kFollows: {
      auto heard_s = player_->heard_s(now);
      if (!heard_s) return std::nullopt;
      if (before_ && now < before_->until)
        return beat_of_song(before_->song, (now - before_->begin).as_seconds(), now);
      if (before_ && now < before_->until + kSettled) heard_s = (now - begin_).as_seconds();
      return beat_of_song(*options_.song, *heard_s, now);
    }
    case State::kStopped: {
      Beat stopped;
      stopped.time = stopped.beat_time = now;
      stopped.clock_id = this_clock_id();
      stopped.beat = stopped_at_beats_;
      stopped.tempo_bpm = options_.song ? options_.song->tempo_bpm(0.0) : 120.0;
      stopped.beats_per_bar = options_.song ? options_.song->beats_per_bar() : 0;
      stopped.confidence = options_.confidence;
      return stopped;
    }
  }
  return std::nullopt;
}

std::optional<Beat> MusicProgram::beat_of_song(const Song& song, double heard_s,
                                               MonoTime now) const {
  const Song::NextBeat next = song.next_beat(heard_s);
  Beat coming;
  coming.time = now;
  coming.clock_id = this_clock_id();
  coming.beat_time = now + Duration::seconds(next.song_s - heard_s);
  coming.beat = next.beat;
  coming.tempo_bpm = std::clamp(next.tempo_bpm, kLeastTempo_bpm, kMostTempo_bpm);
  coming.beats_per_bar = song.beats_per_bar();
  coming.confidence = options_.confidence;
  coming.playing = true;
  // Before the song there is nothing to dance to.
  if (heard_s < 0.0) {
    coming.playing = false;
    coming.beat = song.beat_at(0.0);
    coming.beat_time = now;
  }
  return coming;
}

void MusicProgram::stop(MonoTime now) {
  is_paused_ = false;  // for good
  if (state_ == State::kStopped) return;
  const auto heard_s = player_->heard_s(now);
  const bool was_song = state_ == State::kPlays || state_ == State::kFollows;
  if (was_song && heard_s) stopped_at_beats_ = options_.song->beat_at(std::max(0.0, *heard_s));
  const bool had_published = publisher_->published() > 0;
  if (is_leader_ && was_song)
    bus_.publish(Channel::of(Signal::kMusic, Where::kCapture, options_.guest),
                 room_music_.update_stopped(stopped_at_beats_, now));
  is_leader_ = false;
  player_->pause();
  state_ = State::kStopped;
  if (had_published) publisher_->publish(now);
}

}  // namespace dance
