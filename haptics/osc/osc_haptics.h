// OscHaptics: what is to be felt as messages of Open Sound Control, for vests, gloves and programs
// of others: /dance/haptic/<bone> with amplitude, seconds and hertz as it begins, and the level as
// /avatar/parameters/dance_<bone>, 0 at the end.
//
// Units/frames: amplitude 0 to 1; bones by their names of VRM 1.0.
// Ownership:    owns its socket; never allocates after open().
// Threads:      none inside. Sends in the call.
// Failure:      open() names an address that is none; what cannot be sent is counted.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "consumers/osc/osc_output.h"
#include "core/base/result.h"
#include "haptics/haptic_output.h"

namespace dance {

class OscHaptics final : public HapticOutput {
 public:
  static constexpr const char* kUsualAddress = "127.0.0.1:9001";

  static Result<std::unique_ptr<HapticOutput>> open(const std::string& address);

  bool play(const Haptic& haptic, MonoTime now) override;
  MonoTime work(MonoTime now) override;
  void stop() override;
  std::string summary() const override { return output_.summary(); }

 private:
  explicit OscHaptics(OscOutput output) : output_(std::move(output)), writer_(output_) {}
  void send_level(std::size_t bone, float level);

  OscOutput output_;
  OscBundleWriter writer_;
  std::array<MonoTime, kBoneCount> ends_{};  // not set: nothing is felt there
};

}  // namespace dance
