// MusicProgram: plays a song in a house, alone or in step with its room: starts it or joins the
// room's, publishes the beats heard here, and the song's position while this house leads. A house
// that is alone hears its song while the beats are still being found, and may stop it, play it
// slower and change it.
//
// Units/frames: times of this house's clock.
// Ownership:    owns the player; refers to the bus and the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      where the sound fails it warns and goes on silently. What other houses do is
//               logged.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/guest_id.h"
#include "core/bus/signal_port.h"
#include "core/net/poller.h"
#include "producers/music/beat_publisher.h"
#include "producers/music/music_player.h"
#include "producers/music/room_music.h"
#include "producers/music/song.h"

namespace dance {

struct MusicProgramOptions {
  std::optional<Song> song;  // none: keeps the room's time only
  bool awaits_song = false;  // its beats are being found: set_song() follows
  // In no room. With a guest, the title is published for the windows of the house.
  bool is_alone = false;
  MusicTitle title;
  bool loops = false;       // when this house leads; a joined song ends when its leader ends it
  float confidence = 1.0f;  // of the song's beats
  GuestId guest;            // plays for the room; not set = for this house alone
  bool follows = false;     // joins the room's music where there is some
  MonoTime begin;           // of a song that is not joined
};

class MusicProgram {
 public:
  MusicProgram(MusicProgramOptions options, std::unique_ptr<MusicPlayer> player, SignalPort& bus,
               Poller& poller);
  MusicProgram(const MusicProgram&) = delete;
  MusicProgram& operator=(const MusicProgram&) = delete;

  bool is_over() const { return is_over_; }
  const BeatPublisher& publisher() const { return *publisher_; }
  std::string summary() const { return player_->summary(); }
  void set_volume(double volume) { player_->set_volume(volume); }
  bool has_song() const { return options_.song.has_value(); }
  // The beats that were awaited; a song that is not heard yet begins at `begin`.
  void set_song(Song song, float confidence, MonoTime begin, MonoTime now);

  // In a house that is alone:
  void set_playing(bool plays, MonoTime now);
  void set_speed(double speed, MonoTime now);
  // Another song, whose beats set_song() brings.
  void begin_next(std::unique_ptr<MusicPlayer> player, const MusicTitle& title, MonoTime begin);
  // Publishes to the house and the room that the music has stopped.
  void stop(MonoTime now);

 private:
  // kFinds: the beats are not known yet.
  enum class State { kFinds, kWaits, kPlays, kFollows, kKeepsRoomTime, kStopped };
  // The song as it is heard until a change of speed has passed through the sound server.
  struct Before {
    Song song;
    MonoTime begin;
    MonoTime until;
  };

  void on_room_music(const GuestId& setter, const Music& music, MonoTime now);
  void follow(const GuestId& setter, const Music& music, MonoTime now);
  void wait_for_room(MonoTime now);
  void begin_own(MonoTime now);
  double file_s(MonoTime now) const;
  void publish_title(MonoTime now);
  void play();
  MonoTime work(MonoTime now);
  MonoTime each_second(MonoTime now);
  std::optional<Beat> beat(MonoTime now) const;
  std::optional<Beat> beat_of_song(const Song& song, double heard_s, MonoTime now) const;

  MusicProgramOptions options_;
  std::unique_ptr<MusicPlayer> player_;
  SignalPort& bus_;
  Poller& poller_;
  RoomMusic room_music_;
  std::unique_ptr<BeatPublisher> publisher_;
  State state_ = State::kWaits;
  MonoTime wait_until_;  // for the room's music, before our own begins
  MonoTime begin_;
  bool is_leader_ = false;
  bool is_over_ = false;
  bool warned_of_another_ = false;
  std::optional<Music> room_;
  GuestId room_setter_;
  double stopped_at_beats_ = 0.0;
  double speed_ = 1.0;
  bool is_paused_ = false;
  double paused_at_s_ = 0.0;  // seconds of the file
  std::optional<Before> before_;
};

}  // namespace dance
