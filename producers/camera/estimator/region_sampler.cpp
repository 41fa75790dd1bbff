#include "producers/camera/estimator/region_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dance {
namespace {

// The network sees a little more than the circle about the hips that the body fits in.
constexpr float kMargin = 1.25f;

}  // namespace

void sample_region(const cv::Mat& picture, const BodyRegion& region, int size_px, Beyond beyond,
                   float least, float most, std::span<float> out) {
  const float step = region.side_px / static_cast<float>(size_px);
  const float along_x = std::cos(region.turn_rad) * step;
  const float along_y = std::sin(region.turn_rad) * step;
  const float gain = (most - least) / 255.0f;
  const int last_x = picture.cols - 1, last_y = picture.rows - 1;
  const auto far_x = static_cast<float>(last_x), far_y = static_cast<float>(last_y);
  float* to = out.data();
  for (int row = 0; row < size_px; ++row) {
    const float v = static_cast<float>(row) + 0.5f - 0.5f * static_cast<float>(size_px);
    const float u0 = 0.5f - 0.5f * static_cast<float>(size_px);
    // From here on (0, 0) is the middle of the left upper pixel.
    const float start_x = region.centre_x_px - 0.5f + u0 * along_x - v * along_y;
    const float start_y = region.centre_y_px - 0.5f + u0 * along_y + v * along_x;
    for (int column = 0; column < size_px; ++column, to += 3) {
      const float wished_x = start_x + static_cast<float>(column) * along_x;
      const float wished_y = start_y + static_cast<float>(column) * along_y;
      if (beyond == Beyond::kBlack && (wished_x < -0.5f || wished_y < -0.5f ||
                                       wished_x > far_x + 0.5f || wished_y > far_y + 0.5f)) {
        to[0] = to[1] = to[2] = least;
        continue;
      }
      const float x = std::clamp(wished_x, 0.0f, far_x);
      const float y = std::clamp(wished_y, 0.0f, far_y);
      const int left = static_cast<int>(x), top = static_cast<int>(y);
      const float fx = x - static_cast<float>(left), fy = y - static_cast<float>(top);
      const std::uint8_t* upper = picture.ptr<std::uint8_t>(top) + 3 * left;
      const std::uint8_t* lower = picture.ptr<std::uint8_t>(std::min(top + 1, last_y)) + 3 * left;
      const int next = left < last_x ? 3 : 0;
      for (int c = 0; c < 3; ++c) {
        const auto ul = static_cast<float>(upper[c]), ll = static_cast<float>(lower[c]);
        const float u = ul + fx * (static_cast<float>(upper[c + next]) - ul);
        const float l = ll + fx * (static_cast<float>(lower[c + next]) - ll);
        to[2 - c] = least + gain * (u + fy * (l - u));
      }
    }
  }
}

BodyRegion region_of(const Eigen::Vector2f& middle_px, const Eigen::Vector2f& edge_px) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const Eigen::Vector2f up = edge_px - middle_px;
  // 0 where the body stands upright.
  float turn = 0.5f * kPi - std::atan2(-up.y(), up.x());
  turn -= 2.0f * kPi * std::floor((turn + kPi) / (2.0f * kPi));
  return {middle_px.x(), middle_px.y(), 2.0f * kMargin * up.norm(), turn};
}

}  // namespace dance
