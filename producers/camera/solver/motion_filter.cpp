#include "producers/camera/solver/motion_filter.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// How fast speeds change while people dance (standard deviation, m/s² and rad/s²), and how far from
// the rest posture they are (m and rad). `dance capture solve eval` tuned them.
struct Way {
  int first, count;
  Part part;
  double change;
  double ease[3];
};
constexpr double kAnywhere = 1e4;
constexpr Way kTorsoWays[]{
    {dof::kPlace, 3, Part::kTorso, 7.0, {kAnywhere, kAnywhere, kAnywhere}},
    {dof::kHips, 3, Part::kTorso, 45.0, {kAnywhere, kAnywhere, kAnywhere}},
    {dof::kSpine, 3, Part::kTorso, 30.0, {0.7, 0.5, 0.5}},
    {dof::kHead, 3, Part::kHead, 40.0, {0.7, 0.8, 0.5}},
};
// Of the left side; the right one is alike.
constexpr Way kSideWays[]{
    {dof::kShoulder, 2, Part::kArmLeft, 20.0, {0.12, 0.12, 0.0}},
    {dof::kUpperArm, 3, Part::kArmLeft, 120.0, {1.2, 1.5, 1.5}},
    {dof::kElbow, 1, Part::kArmLeft, 150.0, {1.5, 0.0, 0.0}},
    {dof::kTurn, 1, Part::kHandLeft, 100.0, {0.8, 0.0, 0.0}},
    {dof::kHand, 2, Part::kHandLeft, 100.0, {0.4, 0.3, 0.0}},
    {dof::kUpperLeg, 3, Part::kLegLeft, 90.0, {1.2, 0.5, 0.8}},
    {dof::kKnee, 1, Part::kLegLeft, 130.0, {1.5, 0.0, 0.0}},
    {dof::kFoot, 3, Part::kFootLeft, 130.0, {0.5, 0.4, 0.3}},
};
// Decay times of speeds, visible and hidden.
constexpr double kFade_s = 0.4, kBlindFade_s = 0.12;
// A hidden part is drawn so much more to the rest posture.
constexpr double kBlindEase = 2.2;
// The filter's beta: the share of the prediction error that corrects the speed.
constexpr double kBeta = 0.6;
// Between two pictures of most cameras.
constexpr double kUsual_s = 1.0 / 30.0;
// Between two pictures of the quickest cameras, and a lower bound that avoids division by zero.
constexpr double kLeast_s = 0.002, kNoTime_s = 1e-9;
constexpr double kHardlySeen = 0.1;

template <class Visit>
void visit_ways(Visit visit) {
  for (const Way& way : kTorsoWays) visit(way, way.first, way.part);
  for (int s = 0; s < 2; ++s)
    for (const Way& way : kSideWays) {
      const int shift = s * (static_cast<int>(Part::kArmRight) - static_cast<int>(Part::kArmLeft));
      visit(way, dof::side(s) + way.first, static_cast<Part>(static_cast<int>(way.part) + shift));
    }
}

}  // namespace

PartVisibility visibility_of(const Observation& seen) {
  const auto least = [&seen](std::initializer_list<Landmark> points, std::size_t s) {
    double weight = 1.0;
    for (const Landmark l : points) weight = std::min(weight, seen.weight[index_of(l) + s]);
    return weight;
  };
  PartVisibility visibility{};
  const auto put = [&visibility](Part part, double value) {
    visibility[static_cast<std::size_t>(part)] = value;
  };
  put(Part::kTorso, std::min(least({Landmark::kLeftShoulder, Landmark::kLeftHip}, 0),
                             least({Landmark::kLeftShoulder, Landmark::kLeftHip}, 1)));
  // Points of the head and the hand have half the weight.
  put(Part::kHead,
      2.0 * std::max(seen.weight_of(Landmark::kLeftEar), seen.weight_of(Landmark::kRightEar)));
  for (std::size_t s = 0; s < 2; ++s) {
    const bool left = s == 0;
    put(left ? Part::kArmLeft : Part::kArmRight,
        least({Landmark::kLeftElbow, Landmark::kLeftWrist}, s));
    put(left ? Part::kHandLeft : Part::kHandRight,
        2.5 * least({Landmark::kLeftIndex, Landmark::kLeftPinky}, s));
    put(left ? Part::kLegLeft : Part::kLegRight,
        least({Landmark::kLeftKnee, Landmark::kLeftAnkle}, s));
    put(left ? Part::kFootLeft : Part::kFootRight, least({Landmark::kLeftFootIndex}, s));
  }
  for (double& value : visibility) value = std::min(value, 1.0);
  return visibility;
}

std::uint32_t bones_of(Part part) {
  const auto bits = [](Bone first, std::size_t count) {
    return ((1u << count) - 1u) << index_of(first);
  };
  switch (part) {
    case Part::kTorso:
      return bits(Bone::kHips, 4);
    case Part::kHead:
      return bits(Bone::kNeck, 2);
    case Part::kArmLeft:
      return bits(Bone::kLeftShoulder, 3);
    case Part::kHandLeft:
      return bits(Bone::kLeftHand, 1);
    case Part::kArmRight:
      return bits(Bone::kRightShoulder, 3);
    case Part::kHandRight:
      return bits(Bone::kRightHand, 1);
    case Part::kLegLeft:
      return bits(Bone::kLeftUpperLeg, 2);
    case Part::kFootLeft:
      return bits(Bone::kLeftFoot, 2);
    case Part::kLegRight:
      return bits(Bone::kRightUpperLeg, 2);
    case Part::kFootRight:
      return bits(Bone::kRightFoot, 2);
  }
  return 0;
}

DofVector rest_precision(const PartVisibility& visibility) {
  DofVector precision;
  visit_ways([&](const Way& way, int first, Part part) {
    const bool blind = visibility[static_cast<std::size_t>(part)] < kHardlySeen;
    for (int i = 0; i < way.count; ++i) {
      const double sd = way.ease[i] / (blind && way.ease[i] < kAnywhere ? kBlindEase : 1.0);
      precision[first + i] = 1.0 / (sd * sd);
    }
  });
  return precision;
}

void MotionFilter::begin(const BodyState& state) {
  state_ = state;
  speed_.setZero();
}

Expectation MotionFilter::expect(double seconds, const PartVisibility& visibility) const {
  Expectation expected;
  expected.ease = rest_precision(visibility);
  DofVector step;
  visit_ways([&](const Way& way, int first, Part part) {
    const double fade_s =
        visibility[static_cast<std::size_t>(part)] < kHardlySeen ? kBlindFade_s : kFade_s;
    // ∫ e^(−t/τ) dt
    const double way_s = fade_s * (1.0 - std::exp(-seconds / fade_s));
    // A speed that changes moves the body off by its change times the time squared; of quick
    // cameras' pictures, whose errors last, two shall weigh as much as one of a slow camera's.
    const double sd = way.change * seconds * std::max(seconds, kUsual_s) / std::max(smooth_, 0.05);
    for (int i = 0; i < way.count; ++i) {
      step[first + i] = way_s * speed_[first + i];
      expected.precision[first + i] = 1.0 / (sd * sd);
    }
  });
  expected.state = state_;
  move(expected.state, step);
  return expected;
}

BodyState MotionFilter::before(const Expectation& expected, double seconds) const {
  BodyState state = expected.state;
  move(state, -seconds * speed_);
  return state;
}

void MotionFilter::follow(const Expectation& expected, const BodyState& state, double seconds) {
  const DofVector way = step_between(state_, expected.state),
                  missed = step_between(expected.state, state);
  // What was expected to be gone is the old speed, faded. Pictures that are stamped microseconds
  // apart miss by as much as others do: they do not determine a speed.
  speed_ = way / std::max(seconds, kNoTime_s) + kBeta * missed / std::max(seconds, kLeast_s);
  state_ = state;
}

}  // namespace dance
