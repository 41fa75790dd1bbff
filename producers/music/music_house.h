// MusicHouse: a song in a house and in its room: begins it, or joins it where the room stands, says
// the beat that is heard here, and tells the room where the song stands while it is this house's.
//
// Units/frames: times of this house's clock.
// Ownership:    owns the player; refers to the bus and the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      where the sound ends for good that is said, and the time is kept without. What
//               others do is said.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/guest_id.h"
#include "core/bus/bus.h"
#include "core/net/poller.h"
#include "producers/music/beat_teller.h"
#include "producers/music/music_player.h"
#include "producers/music/room_music.h"
#include "producers/music/song.h"

namespace dance {

struct MusicHouseOptions {
  std::optional<Song> song;  // none: keeps the room's time only
  MusicTitle title;
  bool loops =
      false;  // of a song that is this house's; one that is joined goes on while the room's does
  float confidence = 1.0f;  // of the song's beats
  GuestId guest;            // plays for the room; not set = for this house alone
  bool follows = false;     // joins the room's music where there is some
  MonoTime begin;           // of a song that is not joined
};

class MusicHouse {
 public:
  MusicHouse(MusicHouseOptions options, std::unique_ptr<MusicPlayer> player, Bus& bus,
             Poller& poller);
  MusicHouse(const MusicHouse&) = delete;
  MusicHouse& operator=(const MusicHouse&) = delete;

  bool is_over() const { return is_over_; }
  const BeatTeller& teller() const { return *teller_; }
  std::string summary() const { return player_->summary(); }
  // Says in the house and in the room that the music stands.
  void stop(MonoTime now);

 private:
  enum class State { kWaits, kPlays, kFollows, kKeepsRoomTime, kStopped };

  void hear_room(const GuestId& setter, const Music& music, MonoTime now);
  void follow(const GuestId& setter, const Music& music, MonoTime now);
  void wait_for_room(MonoTime now);
  void begin_own(MonoTime now);
  void play();
  MonoTime work(MonoTime now);
  MonoTime each_second(MonoTime now);
  std::optional<Beat> beat(MonoTime now) const;
  std::optional<Beat> beat_of_song(double heard_s, MonoTime now) const;

  MusicHouseOptions options_;
  std::unique_ptr<MusicPlayer> player_;
  Bus& bus_;
  Poller& poller_;
  RoomMusic room_music_;
  std::unique_ptr<BeatTeller> teller_;
  State state_ = State::kWaits;
  MonoTime wait_until_;  // for the room's music, before our own begins
  MonoTime begin_;
  bool is_leader_ = false;
  bool is_over_ = false;
  bool said_another_ = false;
  std::optional<Music> room_;
  GuestId room_setter_;
  double stood_at_beats_ = 0.0;
};

}  // namespace dance
