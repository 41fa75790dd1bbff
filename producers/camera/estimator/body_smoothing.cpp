#include "producers/camera/estimator/body_smoothing.h"

namespace dance {
namespace {

constexpr OneEuroSetting kImage{0.05, 80.0, 1.0};
constexpr OneEuroSetting kWorld{0.1, 40.0, 1.0};
constexpr OneEuroSetting kRegion{0.01, 10.0, 1.0};
constexpr float kVisibilityWeight = 0.1f;
constexpr double kFirst_hz = 30.0;
constexpr float kLeastSize_px = 1e-6f;

}  // namespace

void BodySmoothing::smooth(MonoTime now, bool only_region, SeenBody& body) {
  const bool is_first = !last_;
  double hz = kFirst_hz;
  if (!is_first) {
    const double passed_s = (now - *last_).as_seconds();
    if (passed_s <= 0.0) return;
    hz = 1.0 / passed_s;
  }
  last_ = now;
  const float size_px = body.size_px();
  const bool has_size = size_px >= kLeastSize_px;
  const double scale = has_size ? 1.0 / size_px : 0.0;
  for (std::size_t i = 0; has_size && i < 2; ++i)
    for (int k = 0; k < 2; ++k)
      body.next_px[i][k] =
          next_[i][static_cast<std::size_t>(k)].next(body.next_px[i][k], hz, scale, kRegion);
  if (only_region) return;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      if (has_size)
        body.image_px[i][k] = image_[i][axis].next(body.image_px[i][k], hz, scale, kImage);
      body.world_m[i][k] = world_[i][axis].next(body.world_m[i][k], hz, 1.0, kWorld);
    }
    float& steady = visibility_[i];
    steady =
        is_first ? body.visibility[i] : steady + kVisibilityWeight * (body.visibility[i] - steady);
    body.visibility[i] = steady;
  }
}

void BodySmoothing::lose() {
  image_ = {};
  next_ = {};
}

void BodySmoothing::reset() { *this = {}; }

}  // namespace dance
