// Two houses with a voice each, as their users start them: a server, dance join, dance voice, and
// a sound server with a room for each of them.
//
// Units/frames: speech as mono samples at 48 kHz; times of this machine's clock.
// Ownership:    owns programs and sound server; they end with it.
// Threads:      one.
// Failure:      names what is missing and the cure.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/bus/bus.h"
#include "core/net/poller.h"
#include "core/program/child_process.h"
#include "testing/voice/sound_rooms.h"

namespace dance {

class VoiceHouses {
 public:
  struct Options {
    std::vector<std::string> voice_words;  // of both
    // Without a server what one house publishes is handed to the other: what buffers alone take.
    bool has_server = true;
    bool bob_hears_his_loudspeaker = false;  // with his microphone
  };

  explicit VoiceHouses(const std::string& folder) : folder_(folder) {}
  ~VoiceHouses();
  VoiceHouses(const VoiceHouses&) = delete;
  VoiceHouses& operator=(const VoiceHouses&) = delete;

  // Returns once all have had time to find each other.
  Result<void> start(const Options& options);
  void end();
  void work_for(Duration time) {
    work_for(time, [] { return false; });
  }
  void work_for(Duration time, const std::function<bool()>& is_done);

  // Sinks mouth-a, ear-a, mouth-b, ear-b, and music-b, another loudspeaker of bob's room.
  SoundRooms& rooms() { return *rooms_; }
  void begin_to_count_cpu();
  double cpu_percent(const std::string& program, Duration over) const;
  // "voice-bob.out", "voice-bob.talk"
  std::string text_of(const std::string& file) const;

 private:
  Result<void> run(const std::string& name, const std::string& program,
                   const std::vector<std::string>& words);
  Result<void> hand_over();
  Result<void> open_house(bool is_a, const Options& options);

  struct Running {
    std::string name;
    ChildProcess process;
    Duration cpu_before;
  };
  std::string folder_;
  std::string server_, url_a_, url_b_;
  std::unique_ptr<SoundRooms> rooms_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Bus> bus_a_, bus_b_;
  std::vector<Running> running_;
};

}  // namespace dance
