// XrHaptics: a headset's two controllers as a device that a dancer feels: what is for an arm in
// that hand, all else in both.
//
// Units/frames: as haptics/haptic_output.h.
// Ownership:    borrows the input, which must outlive it.
// Threads:      one, the poller's.
// Failure:      play() is false where no controller takes it, as while the headset is put down.
#pragma once

#include "haptics/haptic_output.h"
#include "producers/xr/xr_input.h"

namespace dance {

class XrHaptics final : public HapticOutput {
 public:
  XrHaptics(const XrDancerSession& session, const XrInput& input)
      : session_(session), input_(input) {}
  ~XrHaptics() override { stop(); }

  bool play(const Haptic& haptic, MonoTime now) override;
  void stop() override;
  bool is_there() const override { return session_.is_focused(); }
  std::string name() const override { return "the headset's controllers"; }
  std::string summary() const override;

 private:
  const XrDancerSession& session_;
  const XrInput& input_;
  std::uint64_t played_ = 0, refused_ = 0;
};

}  // namespace dance
