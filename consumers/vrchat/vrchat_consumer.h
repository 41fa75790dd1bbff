// VrchatConsumer: sends one dancer to VRChat as trackers over OSC, so that the VRChat user whom it
// is sent to wears that dancer's body. A pose goes out in the call that brings it.
//
// Units/frames: formats/osc/vrchat_writer.h has the messages.
// Ownership:    owns its socket; never allocates after open().
// Threads:      none inside; one owner.
// Failure:      open() names an address that is none; what could not be sent, poses of other guests
//               and poses above the rate are counted: summary() tells.
#pragma once

#include <memory>
#include <string>

#include "consumers/consumer_table.h"
#include "consumers/osc/one_guest.h"
#include "consumers/osc/osc_output.h"
#include "consumers/pose_consumer.h"
#include "consumers/rate_limit.h"
#include "formats/osc/vrchat_writer.h"

namespace dance {

class VrchatConsumer final : public PoseConsumer {
 public:
  static constexpr const char* kUsualAddress = "127.0.0.1:9000";

  static Result<std::unique_ptr<PoseConsumer>> open(const ConsumerOptions& options);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  void on_second(MonoTime) override { output_.report("vrchat"); }
  Result<void> finish() override { return {}; }
  std::string summary() const override;

 private:
  VrchatConsumer(const ConsumerOptions& options, OscOutput output);

  OneGuest guest_;
  RateLimit rate_;
  OscOutput output_;
  VrchatWriter writer_;
  std::uint64_t frames_ = 0;
  std::uint64_t above_rate_ = 0;
};

}  // namespace dance
