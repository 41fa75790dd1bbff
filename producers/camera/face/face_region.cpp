#include "producers/camera/face/face_region.h"

#include "producers/camera/estimator/region_sampler.h"
#include "producers/camera/hands/half_turn.h"
#include "producers/camera/hands/hand_region.h"
#include "producers/camera/hands/tracked_region.h"

namespace dance {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

constexpr float kSearchScale = 3.0f, kFoundScale = 2.0f, kNextScale = 1.5f;
constexpr TrackingLimits kSameFace{radians(15.0f), 0.1f, 0.3f, -0.2f};
constexpr std::size_t kRightEyeCorner = 33, kLeftEyeCorner = 263;

// Of points in the picture, upright.
struct Bounds {
  Vector2f low = Vector2f::Constant(1e30f), high = Vector2f::Constant(-1e30f);
  void add(const Vector2f& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Vector2f middle() const { return 0.5f * (low + high); }
  Vector2f size() const { return high - low; }
};

}  // namespace

std::optional<BodyRegion> face_region_of(const BodyLandmarks& body) {
  if (!body.found) return std::nullopt;
  Bounds bounds;
  for (std::size_t i = 0; i <= index_of(Landmark::kMouthRight); ++i)
    bounds.add(body.image_px[i].head<2>());
  const Vector2f across =
      body.image(Landmark::kLeftEye).head<2>() - body.image(Landmark::kRightEye).head<2>();
  const Vector2f middle = bounds.middle();
  const float side = kSearchScale * bounds.size().maxCoeff();
  if (!middle.allFinite() || !across.allFinite() || !(side >= 1.0f)) return std::nullopt;
  return BodyRegion{middle.x(), middle.y(), side, turn_from_right(across)};
}

BodyRegion face_region_of_points(const BodyRegion& searched,
                                 std::span<const Vector2f, kDetectedFacePoints> points) {
  std::array<Vector2f, kDetectedFacePoints> px;
  Bounds bounds;
  for (std::size_t i = 0; i < px.size(); ++i) {
    px[i] = centre_of(searched) +
            searched.side_px * turned(points[i] - Vector2f(0.5f, 0.5f), searched.turn_rad);
    bounds.add(px[i]);
  }
  const float turn = turn_from_right(px[1] - px[0]);
  // Moved up by a tenth of its height, which need not be its longer side.
  const Vector2f size = bounds.size();
  const BodyRegion up = moved_region(bounds.middle(), size.y(), turn, kFoundScale);
  return {up.centre_x_px, up.centre_y_px, kFoundScale * size.maxCoeff(), turn};
}

BodyRegion face_region_around(std::span<const Vector3f, kFacePointCount> image_px) {
  Bounds bounds;
  for (const Vector3f& p : image_px) bounds.add(p.head<2>());
  const Vector2f across = image_px[kLeftEyeCorner].head<2>() - image_px[kRightEyeCorner].head<2>();
  const Vector2f middle = bounds.middle();
  return {middle.x(), middle.y(), kNextScale * bounds.size().maxCoeff(), turn_from_right(across)};
}

bool is_same_face(std::span<const Vector3f, kFacePointCount> image_px, const BodyRegion& around,
                  const BodyRegion& found) {
  return is_same_part(image_px, around, found, kSameFace);
}

}  // namespace dance
