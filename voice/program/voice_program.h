// VoiceProgram: what `dance voice` does: the microphone to VOICE/capture/<guest>, and VOICE/guest/*
// to the loudspeaker, with what a replay plays on VOICE/capture/*. VOICE_STATE/capture/<guest> says
// what holds, VOICE_LEVEL/capture/<guest> how loud the microphone is.
//
// Units/frames: times of this house's clock.
// Ownership:    owns devices, own voice and the others'; refers to bus and poller, which must
//               outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      open() names what is missing; devices that go are said, and it goes on.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/bus/signal_port.h"
#include "core/net/poller.h"
#include "voice/control/voice_control.h"
#include "voice/device/voice_devices.h"
#include "voice/room/own_voice.h"
#include "voice/room/replayed_voices.h"
#include "voice/room/room_voices.h"

namespace dance {

struct VoiceProgramOptions {
  GuestId guest;
  std::string bus;
  VoiceDeviceOptions devices;
  VoiceCleanerOptions cleaning;
  VoiceEncoderOptions encoding;
  VoiceSettings settings;
  bool has_keys = false;               // of a terminal, where the space bar talks
  std::function<void()> before_words;  // before each line of output, as to clear one of levels
};

class VoiceProgram {
 public:
  static Result<std::unique_ptr<VoiceProgram>> open(const VoiceProgramOptions& options,
                                                    SignalPort& bus, Poller& poller);
  ~VoiceProgram();
  VoiceProgram(const VoiceProgram&) = delete;
  VoiceProgram& operator=(const VoiceProgram&) = delete;

  // As VoiceSettings::apply(), and says what holds now.
  void command(std::string_view command, MonoTime now);
  // Levels of all, for one line of a terminal. Names and levels only.
  std::string meters(MonoTime now) const;
  // What was counted, by guest, as one JSON object.
  std::string report_json() const;
  const VoiceSettings& settings() const { return settings_; }

 private:
  VoiceProgram(const VoiceProgramOptions& options, SignalPort& bus, Poller& poller);
  void subscribe();
  VoiceDeviceHandlers handlers();
  void hear_capture(const GuestId& guest, const Voice& voice, MonoTime now);
  void say_settings() const;
  void report_devices() const;
  void say_hearing(MonoTime now);
  VoiceState state(MonoTime now) const;
  void say_state(MonoTime now);
  void publish_level(MonoTime now);
  // For what is about to be said.
  void before_words() const {
    if (options_.before_words) options_.before_words();
  }

  VoiceProgramOptions options_;
  VoiceSettings settings_;
  SignalPort& bus_;
  Poller& poller_;
  std::unique_ptr<OwnVoice> own_;
  std::unique_ptr<RoomVoices> others_;
  std::unique_ptr<VoiceControl> control_;
  std::unique_ptr<VoiceDevices> devices_;  // last: its sound goes to what stands above
  ReplayedVoices replayed_;
  MonoTime begin_;
  std::optional<VoiceState> said_;  // last
  VoiceLevel level_;                // loudest since it was said last
  Poller::TimerId timer_ = 0;
  Poller::TimerId hearing_timer_ = 0;
};

}  // namespace dance
