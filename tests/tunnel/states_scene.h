// The scene of tests of states: what houses say of it, and lines that lose.
//
// Units/frames: as SimulatedTunnel.
// Ownership:    the fixture owns the tunnel.
// Threads:      none.
// Failure:      none.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "core/bus/encode.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {

inline Avatar avatar_named(std::string_view name) {
  Avatar avatar;
  avatar.name = *AvatarName::parse(name);
  return avatar;
}

inline Placement placed_at(float x_m) {
  Placement placement;
  placement.x_m = x_m;
  return placement;
}

inline Scene scene_named(std::string_view name) {
  Scene scene;
  scene.name = *SceneName::parse(name);
  return scene;
}

inline Style style_of(float hips) {
  Style style;
  style.gain[0] = hips;
  return style;
}

class StatesScene : public ::testing::Test {
 protected:
  // Music that began a minute ago in the house's clock.
  Music music(const SimulatedTunnel::House& house, std::string_view title) {
    Music music;
    music.time = tunnel.time_in(house);
    music.clock_id = house.clock_id;
    music.start_time = tunnel.time_in(house) - Duration::s(60);
    music.tempo_bpm = 180.0;
    music.playing = true;
    EXPECT_TRUE(music.title.assign(title));
    return music;
  }
  // A song that began a second ago in the house's clock.
  RoomSong song(const SimulatedTunnel::House& house, std::uint32_t seed) {
    RoomSong song;
    song.time = tunnel.time_in(house);
    song.clock_id = house.clock_id;
    song.start_time = tunnel.time_in(house) - Duration::s(1);
    song.seed = seed;
    song.playing = true;
    return song;
  }
  template <class Message>
  void say(SimulatedTunnel::House& house, std::string_view who, const Message& message) {
    house.link->send(guest(who), message, tunnel.time_in(house));
  }
  void say_all(SimulatedTunnel::House& house, std::string_view who, float n) {
    say(house, who, average_skeleton(1.6f + n * 0.01f));
    say(house, who, avatar_named("fox-" + std::to_string(static_cast<int>(n))));
    say(house, who, style_of(1.0f + n * 0.1f));
    say(house, who, placed_at(n));
  }
  void lose(double share) {
    tunnel.on_datagram = [this, share](bool, PeerId, wire::Bytes) {
      return random.uniform() >= share;
    };
  }

  SimulatedTunnel tunnel;
  Random random{31};
};

}  // namespace dance
