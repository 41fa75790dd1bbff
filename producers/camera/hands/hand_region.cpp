#include "producers/camera/hands/hand_region.h"

#include <Eigen/Geometry>
#include <cmath>

#include "producers/camera/region/half_turn.h"
#include "producers/camera/region/picture_region.h"
#include "producers/camera/region/tracked_region.h"

namespace dance {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

constexpr float kLeastVisibility = 0.1f;  // of the wrist
constexpr float kSearchScale = 2.7f, kNextScale = 2.0f;
// What the hand of the last picture may differ from the re-crop network's.
constexpr TrackingLimits kSameHand{radians(40.0f), 0.2f, 0.4f, -0.1f};

}  // namespace

std::optional<BodyRegion> hand_region_of(const BodyLandmarks& body, HandSide side) {
  const bool is_left = side == HandSide::kLeft;
  const Landmark wrist = is_left ? Landmark::kLeftWrist : Landmark::kRightWrist;
  if (!body.found || !(body.visible(wrist) > kLeastVisibility)) return std::nullopt;
  const auto at = [&](Landmark l) -> Vector2f { return body.image(l).head<2>(); };
  const Vector2f from = at(wrist);
  const Vector2f middle = (2.0f * at(is_left ? Landmark::kLeftIndex : Landmark::kRightIndex) +
                           at(is_left ? Landmark::kLeftPinky : Landmark::kRightPinky)) /
                          3.0f;
  const Vector2f along = middle - from;
  const BodyRegion region =
      moved_region(middle, 2.0f * along.norm(), turn_from_up(along), kSearchScale);
  if (!middle.allFinite() || !(region.side_px >= 1.0f)) return std::nullopt;
  return region;
}

BodyRegion hand_region_between(const BodyRegion& searched, const Vector2f& middle,
                               const Vector2f& edge) {
  const RegionFrame frame(searched);
  const Vector2f middle_px = frame.in_picture(middle),
                 to_edge_px = frame.in_picture(edge) - middle_px;
  // Its second point lies below the middle, where the other networks' are above.
  const float turn =
      within_half_turns(-0.5f * kHalfTurn_rad - std::atan2(-to_edge_px.y(), to_edge_px.x()));
  return moved_region(middle_px, 2.0f * to_edge_px.norm(), turn, 1.0f);
}

BodyRegion hand_region_around(std::span<const Vector3f, kHandPointCount> image_px) {
  // Of the palm and the fingers' first halves: tips move too much.
  constexpr std::array<std::size_t, 12> kPalm{0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
  const auto at = [&](std::size_t i) -> Vector2f { return image_px[i].head<2>(); };
  const Vector2f knuckles = 0.5f * (0.5f * (at(kHandIndex) + at(kHandRing)) + at(kHandMiddle));
  const float turn = turn_from_up(knuckles - at(kHandWrist));
  Eigen::AlignedBox2f box;  // upright
  for (const std::size_t i : kPalm) box.extend(turned(at(i), -turn));
  const Vector2f size = box.sizes();
  BodyRegion next = moved_region(turned(box.center(), turn), size.y(), turn, 1.0f);
  next.side_px = kNextScale * size.maxCoeff();
  return next;
}

bool is_same_hand(std::span<const Vector3f, kHandPointCount> image_px, const BodyRegion& around,
                  const BodyRegion& recrop) {
  return is_same_part(image_px, around, recrop, kSameHand);
}

}  // namespace dance
