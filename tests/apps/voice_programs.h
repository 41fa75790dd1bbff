// Houses whose guests speak, with a sound server of the test's own and speech made by espeak-ng:
// for the flow tests of voices.
//
// Ownership: the sound server and the programs end with the test.
// Threads:   one.
// Failure:   skips where pulseaudio or espeak-ng is missing.
#pragma once

#include "testing/voice/sound_match.h"
#include "testing/voice/sound_rooms.h"
#include "testing/voice/speech.h"
#include "tests/apps/bus_programs.h"

namespace dance {

constexpr const char* kServerPort = "7469";

class VoicePrograms : public BusPrograms {
 protected:
  void SetUp() override {
    if (!SoundRooms::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
    if (!has_speech_maker()) GTEST_SKIP() << "no espeak-ng: apt-get install espeak-ng";
  }
  void open_rooms() {
    const std::string home = folder_.path("sound");
    std::filesystem::create_directories(home);
    std::filesystem::permissions(home, std::filesystem::perms::owner_all);
    auto rooms = SoundRooms::open(home, {"mouth-a", "ear-a", "mouth-b", "ear-b"});
    ASSERT_TRUE(rooms) << rooms.error().what;
    rooms_ = std::move(*rooms);
  }
  // A house as its user starts it: one line of the session file turns voices on.
  void open_house_of(const std::string& guest, const char* bus, const std::string& side) {
    std::ofstream(folder_.path(guest + ".toml"))
        << "[house]\nguest = \"" << guest << "\"\nserver = \"127.0.0.1:" << kServerPort
        << "\"\nbus = \"" << bus << "\"\n[voice]\nmicrophone = \"mouth-" << side
        << ".monitor\"\nloudspeaker = \"ear-" << side << "\"\n";
    start("dance-join", {folder_.path(guest + ".toml"), "--no-view"});
  }
  std::string talk() { return text_of(folder_.path("talk")); }
  template <class IsDone>
  bool work_until(IsDone is_done, std::chrono::seconds timeout = kTimeout) {
    const MonoTime end = mono_now() + Duration::s(timeout.count());
    while (!is_done()) {
      if (mono_now() >= end) return false;
      rooms_->work(mono_now());
      if (ear_) ear_->drain(mono_now());
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    return true;
  }
  std::unique_ptr<SoundRooms> rooms_;
  std::unique_ptr<Bus> ear_;
};

}  // namespace dance
