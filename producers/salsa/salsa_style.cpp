#include "producers/salsa/salsa_style.h"

#include <cmath>
#include <string>

#include "core/base/random.h"

namespace dance {
namespace {

constexpr float kLeadHeight_m = 1.78f;
constexpr float kFollowHeight_m = 1.66f;

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

void scale_both(Skeleton& skeleton, Bone left, Bone right, const Eigen::Vector3f& factor) {
  for (const Bone bone : {left, right})
    skeleton.offset_m[index_of(bone)] = skeleton.offset(bone).cwiseProduct(factor);
}

}  // namespace

Result<SalsaStyle> checked_style(const SalsaStyle& style) {
  if (!(style.tempo_bpm >= kSlowestSalsa_bpm && style.tempo_bpm <= kFastestSalsa_bpm))
    return fail("tempo " + number(style.tempo_bpm) + " bpm cannot be danced: give " +
                number(kSlowestSalsa_bpm) + " to " + number(kFastestSalsa_bpm));
  if (!(style.energy >= 0.0 && style.energy <= 1.5))
    return fail("energy " + number(style.energy) + " is out of range: give 0 to 1.5");
  if (!(std::abs(style.x_m) <= 900.0 && std::abs(style.z_m) <= 900.0))
    return fail("the place of the couple is off the stage: give x and z within 900 m");
  if (!std::isfinite(style.heading_deg)) return fail("heading is not a number: give degrees");
  if (!(std::abs(style.start_beat) <= 1e9))
    return fail("start beat is out of range: give a number within a thousand million");
  return style;
}

Skeleton salsa_skeleton(SalsaRole role, std::uint64_t seed) {
  const bool is_lead = role == SalsaRole::kLead;
  Random random(seed * 2 + (is_lead ? 0 : 1));
  random.next_u64();
  const auto vary = [&](double share) {
    return static_cast<float>(1.0 + random.uniform(-share, share));
  };

  Skeleton body = average_skeleton((is_lead ? kLeadHeight_m : kFollowHeight_m) * vary(0.01));
  const float legs = vary(0.015);
  const float arms = vary(0.015);
  const float shoulders = (is_lead ? 1.03f : 0.95f) * vary(0.02);
  const float hips = (is_lead ? 0.97f : 1.05f) * vary(0.02);
  scale_both(body, Bone::kLeftUpperLeg, Bone::kRightUpperLeg, {hips, 1.0f, 1.0f});
  scale_both(body, Bone::kLeftLowerLeg, Bone::kRightLowerLeg, {1.0f, legs, 1.0f});
  scale_both(body, Bone::kLeftFoot, Bone::kRightFoot, {1.0f, legs, 1.0f});
  scale_both(body, Bone::kLeftUpperArm, Bone::kRightUpperArm, {shoulders, 1.0f, 1.0f});
  scale_both(body, Bone::kLeftLowerArm, Bone::kRightLowerArm, {arms, 1.0f, 1.0f});
  scale_both(body, Bone::kLeftHand, Bone::kRightHand, {arms, 1.0f, 1.0f});

  // The feet stand on the floor in T-pose: the hips are as high as the legs are long.
  body.offset_m[0].y() = -(body.offset(Bone::kLeftUpperLeg).y() +
                           body.offset(Bone::kLeftLowerLeg).y() + body.offset(Bone::kLeftFoot).y() +
                           body.offset(Bone::kLeftToes).y() + body.tip(Tip::kLeftToes).y());
  body.version = static_cast<std::uint32_t>(seed) * 2u + (is_lead ? 1u : 2u);
  return body;
}

}  // namespace dance
