// ReceivedDancer: what every receiver does with a dancer that it has decoded: checks the pose,
// numbers and stamps it, puts it into the house's captures, and repeats the proportions.
//
// Units/frames: poses and skeletons as core/pose has them; capture times in this house's clock.
// Ownership:    refers to the sink, which must outlive it; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      a pose, hands or a skeleton that are not valid, and a pose that is not newer than
//               the last, are dropped and counted.
#pragma once

#include <cstdint>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "producers/capture_sink.h"

namespace dance {

class ReceivedDancer {
 public:
  struct Counters {
    std::uint64_t poses = 0;
    std::uint64_t invalid = 0;
    std::uint64_t not_newer = 0;
    std::uint64_t skeletons_left_out = 0;  // as others came before they were due
  };

  ReceivedDancer(const GuestId& guest, CaptureSink& sink)
      : guest_(guest), sink_(sink), clock_id_(this_clock_id()) {}

  // Published with the next pose, and once a second. A changed one begins the coding of differences
  // anew at all who hear it, so there is at most one a second, the last. The same again costs
  // nothing.
  void set_skeleton(const Skeleton& skeleton);
  // Rotations, hips, presence and confidence are the caller's; the rest is filled in here. Returns
  // whether it was published.
  bool capture(Pose& pose, MonoTime captured, MonoTime now);
  // The fingers of the pose captured last.
  bool capture(Hands& hands);

  const GuestId& guest() const { return guest_; }
  bool has_skeleton() const { return has_skeleton_; }
  const Skeleton& skeleton() const { return skeleton_; }
  const Counters& counters() const { return counters_; }

 private:
  GuestId guest_;
  CaptureSink& sink_;
  std::uint64_t clock_id_;  // the first to ask for it reads a file
  Skeleton skeleton_ = average_skeleton();
  Skeleton wanted_ = skeleton_;  // is the next to be published
  bool has_skeleton_ = false;
  bool is_changed_ = false;  // wanted_ is not yet published
  MonoTime next_change_;
  MonoTime next_skeleton_;
  MonoTime newest_;
  std::uint32_t sequence_ = 0;
  bool has_begun_ = false;
  Counters counters_;
};

}  // namespace dance
