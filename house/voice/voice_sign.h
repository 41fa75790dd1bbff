// VoiceSign: whether the voice of a house that was started works: its program tells the state of a
// guest's voice once it has its devices, which a sound server that hangs can delay by any time.
//
// Units/frames: times of this machine's clock.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      a state of a program that ends soon after its start, as there is another one for
//               the guest, is the other's and no sign.
#pragma once

#include "core/bus/voice.h"

namespace dance {

class VoiceSign {
 public:
  static constexpr Duration kEndsSoon = Duration::s(1);
  static constexpr Duration kSilent = Duration::s(3);

  explicit VoiceSign(std::uint64_t clock_id) : clock_id_(clock_id) {}

  void see(const VoiceState& state, MonoTime now) {
    if (state.clock_id == clock_id_ && (state.has_microphone || state.has_loudspeaker)) seen_ = now;
  }
  bool works_since(MonoTime started) const {
    return seen_.is_set() && seen_ - started >= kEndsSoon;
  }
  // The program publishes its state once a second.
  bool works(MonoTime now) const { return seen_.is_set() && now - seen_ < kSilent; }

 private:
  std::uint64_t clock_id_;
  MonoTime seen_;  // last
};

}  // namespace dance
