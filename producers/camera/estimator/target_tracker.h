// TargetTracker: which of several people is the tracked one, and whether a new detection can be the
// same body, by its last place and speed.
//
// Units/frames: regions in pixels; times are those of the frames.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; without a recent target one is chosen as FollowOptions says.
#pragma once

#include <optional>
#include <span>

#include "core/base/time.h"
#include "producers/camera/estimator/person_detector.h"

namespace dance {

struct FollowOptions {
  enum class Choice { kSurest, kLargest, kNearest };
  Choice choice = Choice::kSurest;
  Eigen::Vector2f place_px = Eigen::Vector2f::Zero();  // of kNearest
  // For this long after a loss the person most similar in place and size to the lost one is
  // preferred; 0: never.
  Duration reacquire_time = Duration::s(3);
  bool refuses_jumps = true;
  // Searches the whole picture now and then, for IdentitySwitchDetector.
  bool watches_others = true;
};

class TargetTracker {
 public:
  // nullptr where no candidate is plausible.
  const SeenPerson* choose(std::span<const SeenPerson> people, MonoTime now,
                           const FollowOptions& options) const;
  // Whether the target can be in this region now.
  bool is_plausible(const BodyRegion& region, MonoTime now) const;
  // The target was detected in this region.
  void update(const BodyRegion& region, MonoTime now);
  // The target was lost: its speed is no longer known.
  void on_lost() { speed_px_s_.setZero(); }
  void reset() { *this = {}; }

 private:
  std::optional<BodyRegion> last_;
  MonoTime last_time_;
  Eigen::Vector2f speed_px_s_ = Eigen::Vector2f::Zero();
};

}  // namespace dance
