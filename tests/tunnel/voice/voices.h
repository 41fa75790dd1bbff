// A guest who speaks: voices that tell their number, and houses that send and count them.
//
// Units/frames: times are of the house.
// Ownership:    values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {

// A packet of so many bytes that depend on the sequence.
inline Voice voice_number(std::uint32_t sequence, MonoTime capture, std::uint64_t clock_id,
                          std::size_t bytes = 40) {
  Voice voice;
  voice.capture_time = capture;
  voice.clock_id = clock_id;
  voice.sequence = sequence;
  voice.level_dbfs = -20;
  std::array<std::uint8_t, kMaxVoiceBytes> packet;
  for (std::size_t i = 0; i < bytes; ++i) packet[i] = static_cast<std::uint8_t>(sequence * 7 + i);
  if (!voice.set_packet(std::span(packet).first(bytes))) std::abort();
  return voice;
}

// Guests of houses who all speak, a packet each 10 ms.
struct Talk {
  struct Talker {
    SimulatedTunnel::House* house;
    GuestId guest;
    int level_dbfs = -20;
    std::size_t bytes = 40;
    std::uint32_t next = 1;
  };
  SimulatedTunnel& tunnel;
  std::vector<Talker> talkers;

  void say(Talker& talker) {
    Voice voice = voice_number(talker.next++, tunnel.time_in(*talker.house) - Duration::ms(10),
                               talker.house->clock_id, talker.bytes);
    voice.level_dbfs = talker.level_dbfs;
    talker.house->link->send(talker.guest, voice, tunnel.time_in(*talker.house));
  }
  void run(Duration duration) {
    tunnel.run(duration, [this] {
      if (tunnel.now().since_zero_us() / 1000 % kVoiceFrame.count_ms() != 0) return;
      for (Talker& talker : talkers) say(talker);
    });
  }
};

inline std::size_t voices_of(const SimulatedTunnel::House& house, const std::string& name) {
  return static_cast<std::size_t>(
      std::count_if(house.voices.begin(), house.voices.end(),
                    [&](const auto& heard) { return heard.guest.view() == name; }));
}

inline Hearing hearing(const std::vector<std::string>& words) {
  const auto parsed = parse_hearing(words);
  if (!parsed) std::abort();
  return *parsed;
}

}  // namespace dance
