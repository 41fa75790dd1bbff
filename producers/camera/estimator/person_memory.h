// PersonMemory: which of several people is the one who is followed. It knows where that person was
// last and how fast, and says whether what is seen now can be the same body.
//
// Units/frames: regions in pixels; times are those of the frames.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; who is nobody's neighbour is chosen as FollowOptions says.
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
  // So long after a loss whoever is nearest in place and size to the lost one comes first; 0:
  // nobody does.
  Duration remembers = Duration::s(3);
  bool refuses_jumps = true;
  // Looks now and then at the whole picture, to notice who crosses: PeopleWatch.
  bool watches_others = true;
};

class PersonMemory {
 public:
  // nullptr where nobody is there who may be the one.
  const SeenPerson* choose(std::span<const SeenPerson> people, MonoTime now,
                           const FollowOptions& options) const;
  // Whether a body that was where see() said may be in this region now.
  bool is_plausible(const BodyRegion& region, MonoTime now) const;
  // The person was seen in this region.
  void see(const BodyRegion& region, MonoTime now);
  // The person was lost: the speed is no longer known.
  void lose() { speed_px_s_.setZero(); }
  void forget() { *this = {}; }

 private:
  std::optional<BodyRegion> last_;
  MonoTime last_time_;
  Eigen::Vector2f speed_px_s_ = Eigen::Vector2f::Zero();
};

}  // namespace dance
