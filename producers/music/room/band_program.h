// BandProgram: the house band of a house: plays the song of BandRoom, publishes its beats and the
// requests of a dancer, and plays softer while a guest of another house speaks.
//
// Units/frames: times of this house's clock; volumes are factors, 1 = as the band plays.
// Ownership:    owns the player; refers to the bus and the poller, which must outlive it.
// Threads:      runs in the poller's thread.
// Failure:      where the sound fails it warns and goes on silently.
#pragma once

#include <memory>
#include <optional>

#include "core/bus/signal_port.h"
#include "core/net/poller.h"
#include "producers/music/beat_publisher.h"
#include "producers/music/control/music_control.h"
#include "producers/music/music_player.h"
#include "producers/music/room/band_room.h"

namespace dance {

class BandProgram {
 public:
  BandProgram(const BandRoom::Options& options, double volume, SignalPort& bus, Poller& poller);
  BandProgram(const BandProgram&) = delete;
  BandProgram& operator=(const BandProgram&) = delete;

  // Before the first turn of the poller. Its source reads set().
  void set_player(std::unique_ptr<MusicPlayer> player) { player_ = std::move(player); }
  const std::shared_ptr<BandSet>& set() const { return room_.set(); }
  void apply(const MusicCommand& command);
  // The beats stop with the program.
  void stop(MonoTime now);
  const BeatPublisher& publisher() const { return *publisher_; }
  std::string summary() const { return player_->summary(); }

 private:
  MonoTime work(MonoTime now);
  MonoTime each_second(MonoTime now);
  void publish_request();
  void follow_song(MonoTime now);
  void set_gain(MonoTime now);
  std::optional<Beat> beat(MonoTime now);
  Beat beat_of_set(double set_s, MonoTime now);

  GuestId guest_;
  double volume_;
  SignalPort& bus_;
  BandRoom room_;
  std::unique_ptr<MusicPlayer> player_ = std::make_unique<SilentPlayer>();
  std::unique_ptr<BeatPublisher> publisher_;
  std::optional<Music> room_music_;
  std::optional<RoomSong> played_, published_;
  bool is_playing_ = false;
  bool is_over_ = false;
  MonoTime spoken_;  // when another house's voice arrived last
};

}  // namespace dance
