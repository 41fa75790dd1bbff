// MotionMemory: how a body has just moved, and from that where it is expected in the next picture,
// and how surely. What is seen well goes where it is seen; what is not goes on as it did, ever
// slower, and then to a posture at ease.
//
// Units/frames: the ways to move of body_state.h; seconds.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       an alpha-beta filter whose alpha is what the fit makes of precision and picture:
//               Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and
//               Navigation, 2001, chapter 6.
#pragma once

#include <array>

#include "producers/camera/solver/body_fit.h"
#include "producers/camera/solver/body_state.h"
#include "producers/camera/solver/observation.h"

namespace dance {

// The parts of a body that come in and out of sight together.
enum class Part : std::uint8_t {
  kTorso,
  kHead,
  kArmLeft,
  kHandLeft,
  kLegLeft,
  kFootLeft,
  kArmRight,
  kHandRight,
  kLegRight,
  kFootRight,
};
constexpr std::size_t kPartCount = 10;
using PartSight = std::array<double, kPartCount>;  // 0…1

PartSight sight_of(const Observation& seen);
// The bones of a part, as bits of Pose::presence.
std::uint32_t bones_of(Part part);

class MotionMemory {
 public:
  // `smooth`: 1 is as tuned, 0 hardly smooths, 2 twice as much.
  void set_smooth(double smooth) { smooth_ = smooth; }
  void begin(const BodyState& state);
  const BodyState& state() const { return state_; }

  // Where the body is after `seconds`, from what is seen of it now.
  Expectation expect(double seconds, const PartSight& sight) const;
  // It was there.
  void follow(const Expectation& expected, const BodyState& state, double seconds);
  // The same body, told in another W or with other bones: speeds stay.
  void retell(const BodyState& state) { state_ = state; }

 private:
  BodyState state_;
  DofVector speed_ = DofVector::Zero();
  double smooth_ = 1.0;
};

// Of a body at ease in a picture that shows this much of it; also for a first picture, when nothing
// is expected.
DofVector precision_of_ease(const PartSight& sight);

}  // namespace dance
