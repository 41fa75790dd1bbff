// StageSpacing: moves apart dancers who overlap on this stage, for example two who each dance in
// the middle of their own room. Of two, the one whose name sorts later moves to a free spot beside
// the other and stays there, so that every stage finds the same spots. Dancers who hold hands are
// not moved, nor are two dancers of this house.
//
// Units/frames: metres in W; times of this house's clock.
// Ownership:    room for kMostDancers, those of this house first, then those nearest to them. Never
//               allocates.
// Failure:      more dancers than there is room for are shown as they are.
#pragma once

#include <array>

#include "core/pose/pose.h"
#include "transformers/touch/stage_holds.h"
#include "transformers/touch/stage_places.h"

namespace dance {

class StageSpacing {
 public:
  static constexpr std::size_t kMostDancers = 16;
  // Hips of partners in the closest embrace are 0.3 m apart; they hold hands.
  static constexpr float kOverlap_m = 0.3f;
  // An arm's length, so that two who were moved apart can take hands.
  static constexpr float kApart_m = 0.8f;
  // A dancer who walks away by this much goes back to the spot where it really is.
  static constexpr float kReturn_m = 1.3f;
  static constexpr Duration kOverlapTimeout = Duration::s(2);
  static constexpr Duration kReturnTimeout = Duration::s(5);
  static constexpr Duration kGone = Duration::s(2);

  // Call with each pose that is about to be shown. `holds` has the hands as shown.
  void apply(const GuestId& guest, Pose& pose, MonoTime now, DancerOf of, const StageHolds& holds);

 private:
  struct Dancer : StagePlace {  // p_WH_m: as captured
    Eigen::Vector3f target_m = Eigen::Vector3f::Zero(), offset_m = Eigen::Vector3f::Zero(),
                    speed_m_s = Eigen::Vector3f::Zero();
    MonoTime overlapped, walked_away;  // since when; not set: it does not
    bool is_moved() const { return !target_m.isZero(); }
    Eigen::Vector3f spot_m() const { return p_WH_m + target_m; }
  };

  Dancer* place_of(const GuestId& guest, const Pose& pose, MonoTime now, DancerOf of);
  template <class Is>
  bool any_before(const Dancer& dancer, MonoTime now, Is is) const;
  void choose_target(Dancer& dancer, MonoTime now, const StageHolds& holds);
  Eigen::Vector3f free_target_m(const Dancer& dancer, MonoTime now) const;

  std::array<Dancer, kMostDancers> dancers_;
};

}  // namespace dance
