// MotionFilter: predicts a body's state and its uncertainty for the next picture. Visible parts
// follow the measurement; hidden ones continue with decaying speed, towards the rest posture.
//
// Units/frames: the ways to move of body_state.h; seconds.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       an alpha-beta filter whose alpha results from the fit:
//               Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and
//               Navigation, 2001, chapter 6.
#pragma once

#include <array>

#include "producers/camera/solver/body_fit.h"
#include "producers/camera/solver/body_state.h"
#include "producers/camera/solver/observation.h"

namespace dance {

// The parts of a body that become hidden together.
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
using PartVisibility = std::array<double, kPartCount>;  // 0…1

PartVisibility visibility_of(const Observation& seen);
// The bones of a part, as bits of Pose::presence.
std::uint32_t bones_of(Part part);

class MotionFilter {
 public:
  // `smooth`: 1 is as tuned, 0 hardly smooths, 2 twice as much.
  void set_smooth(double smooth) { smooth_ = smooth; }
  void begin(const BodyState& state);
  const BodyState& state() const { return state_; }

  // The prediction after `seconds`, given which parts are visible now.
  Expectation expect(double seconds, const PartVisibility& visibility) const;
  // Where the prediction has the body so many seconds before it; negative: after it.
  BodyState before(const Expectation& expected, double seconds) const;
  // Corrects with the fitted state.
  void follow(const Expectation& expected, const BodyState& state, double seconds);
  // The same body in another W or with other bones: speeds stay.
  void rebase(const BodyState& state) { state_ = state; }

 private:
  BodyState state_;
  DofVector speed_ = DofVector::Zero();
  double smooth_ = 1.0;
};

// Precision of the rest posture given the visible parts; also for a first picture, without a
// prediction.
DofVector rest_precision(const PartVisibility& visibility);

}  // namespace dance
