#include "headset/comfort/comfort.h"

#include <algorithm>

#include "core/pose/kinematics.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kGone = 1.0f / 3.0f;  // of the personal space
constexpr Duration kDark = Duration::ms(120), kFades = Duration::ms(350);

}  // namespace

float opacity_at(float distance_m, float personal_space_m) {
  if (personal_space_m <= 0.0f) return 1.0f;
  const float share = (distance_m / personal_space_m - kGone) / (1.0f - kGone);
  return std::clamp(share, 0.0f, 1.0f);
}

float distance_to_guest_m(const Vector3f& eyes_W_m, const SceneGuest& guest) {
  BodyFrames frames;
  forward_kinematics(guest.skeleton, guest.pose, frames);
  const Vector3f low = frames.position(Bone::kHips);
  const Vector3f high = frames.tip(Tip::kHead);
  const Vector3f along = high - low;
  const float length2 = std::max(along.squaredNorm(), 1e-6f);
  const float at = std::clamp((eyes_W_m - low).dot(along) / length2, 0.0f, 1.0f);
  return (eyes_W_m - low - at * along).norm();
}

void keep_personal_space(const ComfortSettings& settings, const Vector3f& eyes_W_m,
                         const GuestId& own, std::span<SceneGuest> guests) {
  for (SceneGuest& guest : guests)
    if (guest.id != own)
      guest.opacity *= opacity_at(distance_to_guest_m(eyes_W_m, guest), settings.personal_space_m);
}

float JumpFade::darkness(MonoTime now) const {
  if (!jumped_.is_set()) return 0.0f;
  const Duration since = now - jumped_;
  if (since < kDark) return 1.0f;
  const double share = (since - kDark).as_seconds() / kFades.as_seconds();
  return static_cast<float>(std::clamp(1.0 - share, 0.0, 1.0));
}

}  // namespace dance
