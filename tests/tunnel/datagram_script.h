// The scene that fuzz targets play in, and the notation of their inputs: two houses in a room, one
// pose each way, then datagrams as the input says. The scene is the same every time, random numbers
// included, so that the corpus's datagrams belong to it.
//
// Units/frames: a script is a row of steps: a byte (low 2 bits: which peer; high 4 bits: tenths of
//               a second that pass first), a length of 16 bits (little-endian), the datagram.
// Ownership:    looks at the caller's bytes.
// Threads:      none.
// Failure:      a script that ends in the middle ends there.
#pragma once

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {

struct FuzzScene {
  FuzzScene() : tunnel(limits()) {
    for (const char* line : {"LIGHT/desk class=state layout=n:i32,f32[n],string",
                             "ROBOT/* class=newest layout=any unchecked=yes"})
      tunnel.link_options.channels.push_back(*ChannelRule::parse(line));
    a = &tunnel.add_house("salsa", {"alice"});
    b = &tunnel.add_house("salsa", {"bob"});
    tunnel.run(Duration::ms(40));
    tunnel.dance(*a, guest("alice"));
    tunnel.dance(*b, guest("bob"));
    tunnel.run(Duration::ms(15));
  }
  static ServerLimits limits() {
    ServerLimits small;
    small.sessions = 6;
    small.rooms = 3;
    return small;
  }

  template <class Deliver>
  void play(wire::Bytes script, Deliver deliver) {
    ByteReader in(script);
    // 64 steps and 3 s are plenty (time-outs are at 2 s), and bound the work of one input.
    int tenths_left = 30;
    for (int step = 0; step < 64 && in.remaining() > 0; ++step) {
      const std::uint8_t how = in.u8();
      const std::size_t size = in.u16();
      const auto datagram = in.bytes(std::min(size, in.remaining()));
      const int tenths = std::min(how >> 4, tenths_left);
      tenths_left -= tenths;
      if (tenths > 0) tunnel.run(Duration::ms(100) * tenths);
      deliver(how & 3, datagram);
    }
    tunnel.run(Duration::ms(20));
    for (const auto* house : {a, b})
      for (const auto& heard : house->poses) DANCE_ASSERT(is_valid(heard.pose));
    for (const auto* house : {a, b})
      for (const auto& heard : house->voices) DANCE_ASSERT(is_valid(heard.voice));
    DANCE_ASSERT(tunnel.server().session_count() <= limits().sessions);
    DANCE_ASSERT(tunnel.server().room_count() <= limits().rooms);
  }

  SimulatedTunnel tunnel;
  SimulatedTunnel::House* a = nullptr;
  SimulatedTunnel::House* b = nullptr;
};

}  // namespace dance
