// VmcConsumer: sends one dancer to a program that speaks the VMC protocol: VSeeFace, a Unity scene
// with EVMC4U, Blender, Unreal. A pose goes out in the call that brings it.
//
// Units/frames: /VMC/Ext/T is the pose's capture time, in seconds from the first pose sent, so that
//               frames keep the time between them whatever the network does.
// Ownership:    owns its socket; never allocates after open().
// Threads:      none inside; one owner.
// Failure:      open() names an address that is none; what could not be sent, poses of other guests
//               and poses above the rate are counted: summary() tells.
// Source:       formats/osc/vmc_writer.h has the messages.
#pragma once

#include <memory>
#include <string>

#include "consumers/consumer_table.h"
#include "consumers/osc/one_guest.h"
#include "consumers/osc/osc_output.h"
#include "consumers/pose_consumer.h"
#include "consumers/rate_limit.h"
#include "formats/osc/vmc_writer.h"

namespace dance {

class VmcConsumer final : public PoseConsumer {
 public:
  static constexpr const char* kUsualAddress = "127.0.0.1:39539";
  // With no pose for so long the dancer counts as silent.
  static constexpr Duration kSilence = Duration::s(1);
  // Fingers that do not come for so long are no longer known.
  static constexpr Duration kHandsKept = Duration::s(2);
  static constexpr Duration kFaceKept = Duration::s(2);

  static Result<std::unique_ptr<PoseConsumer>> open(const ConsumerOptions& options);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  void on_hands(const GuestId& guest, const Hands& hands, MonoTime now) override;
  void on_face(const GuestId& guest, const Face& face, MonoTime now) override;
  void on_second(MonoTime now) override;
  Result<void> finish() override;
  std::string summary() const override;

 private:
  VmcConsumer(const ConsumerOptions& options, OscOutput output);
  float time_of(const Pose& pose, MonoTime now);

  OneGuest guest_;
  RateLimit rate_;
  OscOutput output_;
  VmcWriter writer_;
  Skeleton skeleton_ = average_skeleton();
  Hands hands_;
  bool has_hands_ = false;
  MonoTime hands_heard_;
  Face face_;
  bool has_face_ = false;
  MonoTime face_heard_;
  bool is_silent_ = true;
  MonoTime heard_;     // the newest pose, on this host's clock
  MonoTime captured_;  // the same, and the zero of T, on the clock that poses are stamped by
  MonoTime zero_;
  std::uint64_t clock_id_ = 0;
  float time_s_ = 0.0f;  // the newest T
  std::uint64_t frames_ = 0;
  std::uint64_t above_rate_ = 0;
  std::uint64_t silences_ = 0;
};

}  // namespace dance
