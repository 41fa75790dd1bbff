// SoundOutput: a tactor on a sound channel, through PulseAudio or PipeWire: tones on a sink of
// their own. The stream never stops, so that a tone begins within its short buffer; the sound
// server says how late that is, and orders go out so much earlier.
//
// Units/frames: 48000 mono frames a second.
// Ownership:    owns the connection and its thread; 64 orders may wait for it.
// Threads:      one, named haptics-snd, in which tones are mixed; play() waits for nothing.
// Failure:      open() says why there is no sound server, or no such sink, and the cure, after a
//               few seconds at most. A server that ends is looked for again each second by the
//               thread and told in summary(); orders are refused meanwhile.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "haptics/haptic_output.h"

namespace dance {

class SoundOutput final : public HapticOutput {
 public:
  // `sink`: its name at the sound server; "" = the usual one.
  static Result<std::unique_ptr<HapticOutput>> open(const std::string& sink);
  // One that is not there yet.
  static std::unique_ptr<HapticOutput> later(const std::string& sink);
  ~SoundOutput() override;

  bool play(const Haptic& haptic, MonoTime now) override;
  void set_limit(float limit) override;
  void stop() override;
  bool is_there() const override;
  std::string name() const override;
  Duration latency() const override;
  std::string summary() const override;

 private:
  struct Impl;
  explicit SoundOutput(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dance
