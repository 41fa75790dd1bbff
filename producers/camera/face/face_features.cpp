#include "producers/camera/face/face_features.h"

namespace dance {

using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// Points of the mesh, of the left side and of the right one.
struct Pair {
  std::size_t left, right;
};
constexpr Pair kOuterEye{263, 33}, kInnerEye{362, 133}, kUpperLidPoint{386, 159},
    kLowerLidPoint{374, 145}, kInnerBrowPoint{285, 55}, kOuterBrowPoint{300, 70},
    kMouthCorner{291, 61}, kUpperLipSide{270, 40}, kLowerLipSide{321, 91}, kWing{358, 129},
    kCheekPoint{330, 101};
constexpr std::size_t kForehead = 10, kBelowNose = 2, kChin = 152, kUpperLipEdge = 0,
                      kUpperLipInside = 13, kLowerLipInside = 14, kLowerLipEdge = 17;
constexpr float kLeastFace_px = 4.0f;
// The forehead lies behind the upper lip: of the mesh at rest.
constexpr float kForeheadBack_rad = 0.152f;

}  // namespace

std::optional<CapturedFaceShape> shape_of(const FaceLandmarks& face) {
  const auto& px = face.image_px;
  const Vector3f left = px[kOuterEye.left] - px[kOuterEye.right];
  const Vector3f up = px[kForehead] - px[kBelowNose];
  const Vector3f forward = left.cross(up);
  if (!forward.allFinite() || !(left.norm() > kLeastFace_px) || !(up.norm() > kLeastFace_px) ||
      !(forward.norm() > kLeastFace_px * kLeastFace_px))
    return std::nullopt;
  Matrix3f R;
  R.col(0) = left.normalized();
  R.col(2) = forward.normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  CapturedFaceShape shape;
  shape.R_CHead =
      (Quaternionf(R) * Quaternionf(Eigen::AngleAxisf(kForeheadBack_rad, Vector3f::UnitX())))
          .normalized();
  shape.eyes_px = left.norm();
  const float scale = 1.0f / shape.eyes_px;
  const Vector3f nose = px[kBelowNose];
  const auto at = [&](std::size_t i) -> Vector3f {
    return scale * (R.transpose() * (px[i] - nose));
  };
  const auto apart = [&](std::size_t a, std::size_t b) { return (at(a) - at(b)).norm(); };
  FaceFeatures& f = shape.features;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto of = [&](Pair pair) { return side == 0 ? pair.left : pair.right; };
    const float outwards = side == 0 ? 1.0f : -1.0f;
    const float eye_y = 0.5f * (at(of(kOuterEye)).y() + at(of(kInnerEye)).y());
    const float width = std::max(0.05f, apart(of(kOuterEye), of(kInnerEye)));
    f[kLidGap + side] = (at(of(kUpperLidPoint)).y() - at(of(kLowerLidPoint)).y()) / width;
    f[kLowerLid + side] = at(of(kLowerLidPoint)).y() - eye_y;
    f[kInnerBrow + side] = at(of(kInnerBrowPoint)).y() - eye_y;
    f[kOuterBrow + side] = at(of(kOuterBrowPoint)).y() - eye_y;
    f[kMouthCornerUp + side] = at(of(kMouthCorner)).y();
    f[kMouthCornerOut + side] = outwards * at(of(kMouthCorner)).x();
    f[kUpperLip + side] = at(of(kUpperLipSide)).y();
    f[kLowerLip + side] = at(of(kLowerLipSide)).y() - at(kChin).y();
    f[kNoseWing + side] = at(of(kWing)).y() - at(of(kInnerEye)).y();
    f[kCheek + side] = apart(of(kCheekPoint), of(kLowerLidPoint));
  }
  f[kChinDown] = -at(kChin).y();
  f[kChinLeft] = at(kChin).x();
  f[kLipGap] = apart(kUpperLipInside, kLowerLipInside);
  f[kMouthWidth] = apart(kMouthCorner.left, kMouthCorner.right);
  f[kUpperLipRed] = apart(kUpperLipEdge, kUpperLipInside);
  f[kLowerLipRed] = apart(kLowerLipEdge, kLowerLipInside);
  f[kLowerLipUp] = at(kLowerLipEdge).y();
  f[kUpperLipUp] = at(kUpperLipEdge).y();
  return shape;
}

}  // namespace dance
