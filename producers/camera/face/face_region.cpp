#include "producers/camera/face/face_region.h"

#include <Eigen/Geometry>

#include "producers/camera/region/half_turn.h"
#include "producers/camera/region/picture_region.h"
#include "producers/camera/region/tracked_region.h"

namespace dance {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

constexpr float kSearchScale = 3.0f, kFoundScale = 2.0f, kNextScale = 1.5f;
constexpr TrackingLimits kSameFace{radians(15.0f), 0.1f, 0.3f, -0.2f};
constexpr std::size_t kRightEyeCorner = 33, kLeftEyeCorner = 263;

}  // namespace

std::optional<BodyRegion> face_region_of(const BodyLandmarks& body) {
  if (!body.found) return std::nullopt;
  Eigen::AlignedBox2f bounds;
  for (std::size_t i = 0; i <= index_of(Landmark::kMouthRight); ++i)
    bounds.extend(body.image_px[i].head<2>());
  const Vector2f across =
      body.image(Landmark::kLeftEye).head<2>() - body.image(Landmark::kRightEye).head<2>();
  const Vector2f middle = bounds.center();
  const float side = kSearchScale * bounds.sizes().maxCoeff();
  if (!middle.allFinite() || !across.allFinite() || !(side >= 1.0f)) return std::nullopt;
  return BodyRegion{middle.x(), middle.y(), side, turn_from_right(across)};
}

BodyRegion face_region_of_points(const BodyRegion& searched,
                                 std::span<const Vector2f, kDetectedFacePoints> points) {
  const RegionFrame frame(searched);
  std::array<Vector2f, kDetectedFacePoints> px;
  Eigen::AlignedBox2f bounds;
  for (std::size_t i = 0; i < px.size(); ++i) {
    px[i] = frame.in_picture(points[i]);
    bounds.extend(px[i]);
  }
  const float turn = turn_from_right(px[1] - px[0]);
  // Moved up by a tenth of its height, which need not be its longer side.
  const Vector2f size = bounds.sizes();
  BodyRegion found = moved_region(bounds.center(), size.y(), turn, 1.0f);
  found.side_px = kFoundScale * size.maxCoeff();
  return found;
}

BodyRegion face_region_around(std::span<const Vector3f, kFacePointCount> image_px) {
  Eigen::AlignedBox2f bounds;
  for (const Vector3f& p : image_px) bounds.extend(p.head<2>());
  const Vector2f across = image_px[kLeftEyeCorner].head<2>() - image_px[kRightEyeCorner].head<2>();
  const Vector2f middle = bounds.center();
  return {middle.x(), middle.y(), kNextScale * bounds.sizes().maxCoeff(), turn_from_right(across)};
}

bool is_same_face(std::span<const Vector3f, kFacePointCount> image_px, const BodyRegion& around,
                  const BodyRegion& found) {
  return is_same_part(image_px, around, found, kSameFace);
}

}  // namespace dance
