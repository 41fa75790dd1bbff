#include "viewer/stage/contact_spots.h"

#include <algorithm>

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kReferenceHeight_m = 1.72f;
constexpr float kThighAndShin_m = 0.82f;  // of a body of that height

// From what the figure is now: an avatar's legs are not its dancer's.
float scale_of(const BodyFrames& frames) {
  const float leg_m =
      (frames.position(Bone::kLeftUpperLeg) - frames.position(Bone::kLeftLowerLeg)).norm() +
      (frames.position(Bone::kLeftLowerLeg) - frames.position(Bone::kLeftFoot)).norm();
  return std::clamp(leg_m / kThighAndShin_m, 0.3f, 3.0f);
}

// What is over the floor, as large as on a body of the reference height.
struct Shape {
  float half_length_m;
  float half_width_m;
  float half_height_m;  // where the spot is half as dark
  float darkness;
};
// Chosen by eye.
constexpr Shape kFoot{0.24f, 0.13f, 0.06f, 0.62f};
constexpr Shape kHips{0.42f, 0.36f, 0.9f, 0.42f};

}  // namespace

void append_contact_spots(const PosedFigure& figure, std::vector<ContactSpot>& spots) {
  const BodyFrames& frames = figure.frames;
  const float scale = scale_of(frames);
  const auto add = [&](const Vector3f& over_W_m, const Vector3f& along_W, const Shape& shape) {
    const float height = std::max(0.0f, over_W_m.y()) / (scale * shape.half_height_m);
    Vector3f along(along_W.x(), 0.0f, along_W.z());
    if (along.squaredNorm() < 1e-4f) along = Vector3f::UnitX();
    const float spread = 1.0f + 0.6f * std::min(height, 2.0f);
    spots.push_back({Vector3f(over_W_m.x(), 0.0f, over_W_m.z()),
                     scale * shape.half_length_m * spread, along.normalized(),
                     scale * shape.half_width_m * spread,
                     figure.opacity * shape.darkness / (1.0f + height * height)});
  };
  for (const auto& [foot, toes] : {std::pair{Bone::kLeftFoot, Bone::kLeftToes},
                                   std::pair{Bone::kRightFoot, Bone::kRightToes}}) {
    const Vector3f& heel = frames.position(foot);
    const Vector3f& ball = frames.position(toes);
    Vector3f middle = 0.45f * heel + 0.55f * ball;
    middle.y() = std::min(heel.y() - 0.08f * scale, ball.y() - 0.02f * scale);
    add(middle, ball - heel, kFoot);
  }
  const Vector3f across = frames.R_WB[index_of(Bone::kHips)] * Vector3f::UnitX();
  add(frames.position(Bone::kHips), across, kHips);
}

}  // namespace dance
