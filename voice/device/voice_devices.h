// VoiceDevices: microphone and loudspeaker of this machine with small buffers, and what the
// loudspeaker, or another sink, plays of all programs (its monitor), as a reference for echoes.
//
// Units/frames: mono frames of 10 ms at 48 kHz from the microphone and the monitor; stereo,
//               interleaved, to the loudspeaker; times of this house's clock.
// Ownership:    owns its connection with the sound server.
// Threads:      none inside: all handlers run in work(), which is to be called every two
//               milliseconds or so.
// Failure:      open() names what is missing; a device that goes is said by trouble(), once, and
//               looked for again every two seconds. While a sound server answers slowly, work()
//               waits for it, for each device up to 0.8 s where another works, else up to 3 s.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/sound/pulse_input.h"
#include "core/sound/pulse_output.h"
#include "core/sound/stream_clock.h"
#include "voice/device/device_troubles.h"
#include "voice/frame/voice_sound.h"

namespace dance {

struct VoiceDeviceOptions {
  std::string microphone;   // as `pactl list short sources` names it; "" = the default
  std::string loudspeaker;  // as `pactl list short sinks` names it; "" = the default
  bool has_reference = true;
  std::string reference;  // the sink whose sound is to be taken out; "" = the loudspeaker above
  Duration ahead = Duration::ms(20);  // buffered before the loudspeaker
};

struct VoiceDeviceHandlers {
  static constexpr std::size_t kFrame = kVoiceFrameSamples;
  // The first sample of the frame met the microphone at `captured`. `echo_delay`: from the
  // reference's call until this one, of the same sound.
  std::function<void(std::span<float, kFrame> frame, MonoTime captured, Duration echo_delay)>
      on_microphone;
  std::function<void(std::span<const float, kFrame> frame)> on_reference;
  // To be filled; the first of it is heard at `heard`.
  std::function<void(std::span<float> stereo, MonoTime now, MonoTime heard)> fill;
};

class VoiceDevices {
 public:
  static constexpr Duration kTurn = Duration::ms(2);

  // Fails where there is neither microphone nor loudspeaker; one of them is enough.
  static Result<std::unique_ptr<VoiceDevices>> open(const VoiceDeviceOptions& options,
                                                    VoiceDeviceHandlers handlers);
  VoiceDevices(const VoiceDevices&) = delete;
  VoiceDevices& operator=(const VoiceDevices&) = delete;

  void work(MonoTime now);
  bool has_microphone() const { return microphone_ != nullptr; }
  bool has_loudspeaker() const { return loudspeaker_ != nullptr; }
  // Names missing devices and the cure; each error is returned once.
  std::string take_errors() { return troubles_.take(); }
  // Names devices that work again; each recovery is returned once.
  std::string take_recoveries() { return troubles_.take_recoveries(); }
  std::uint64_t underflows() const { return underflows_; }
  Duration ahead() const { return ahead_; }

 private:
  // Samples until they make a frame.
  struct Gathered {
    std::array<float, VoiceDeviceHandlers::kFrame> frame{};
    std::size_t count = 0;
    // `end`: samples of the stream so far. Calls on_frame(begin) for each frame that is full.
    template <class OnFrame>
    void add(std::span<const float> samples, std::int64_t end, OnFrame on_frame) {
      std::int64_t begin = end - static_cast<std::int64_t>(samples.size() + count);
      for (const float sample : samples) {
        frame[count++] = sample;
        if (count < frame.size()) continue;
        count = 0;
        on_frame(begin);
        begin += static_cast<std::int64_t>(frame.size());
      }
    }
  };

  VoiceDevices(const VoiceDeviceOptions& options, VoiceDeviceHandlers handlers)
      : options_(options), handlers_(std::move(handlers)), ahead_(options.ahead) {}
  Result<void> connect();
  void open_microphone();
  void open_loudspeaker();
  void open_reference();
  void on_microphone(std::span<const float> samples);
  void on_reference(std::span<const float> samples);
  void look_for_lost();
  void fill(MonoTime now);
  void fit_buffer(MonoTime now);
  template <class Device>
  void keep(VoiceDevice device, std::unique_ptr<Device>& place,
            Result<std::unique_ptr<Device>> opened);

  VoiceDeviceOptions options_;
  VoiceDeviceHandlers handlers_;
  Duration ahead_;  // at present
  StreamClock heard_{48'000.0};
  Gathered from_microphone_, from_reference_;
  Duration reference_ahead_;  // of what the monitor has, until it is heard
  std::unique_ptr<PulseServer> server_;
  std::unique_ptr<PulseInput> microphone_, reference_;  // after what their samples go to
  std::unique_ptr<PulseOutput> loudspeaker_;
  DeviceTroubles troubles_;
  MonoTime next_timing_, next_look_, next_fit_;
  Duration timeout_ = PulseServer::kTimeout;  // with the sound server, while all waits for it
  std::uint64_t underflows_ = 0, underflows_before_ = 0;
  int calm_looks_ = 0;
  std::array<float, 2 * 4800> block_{};
};

}  // namespace dance
