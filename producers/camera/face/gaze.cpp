#include "producers/camera/face/gaze.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>

namespace dance {

using Eigen::Vector2f;

namespace {

// Corners from the dancer's right to the left, and lids.
struct Eye {
  std::size_t right, left, upper, lower;
};
constexpr Eye kEyes[] = {{33, 133, 159, 145}, {362, 263, 386, 374}};
constexpr int kAcross = 24, kDown = 12;
// Lids nearer than this are closed; of the eye's width.
constexpr float kLeastGap = 0.14f;
// An eye's width over the eyeball's radius.
constexpr float kWidthInRadii = 2.5f;
constexpr float kMostSine = 0.7f;

float brightness(const cv::Mat& picture, const Vector2f& px) {
  const int x = static_cast<int>(px.x()), y = static_cast<int>(px.y());
  const std::uint8_t* pixel = picture.ptr<std::uint8_t>(y) + 3 * x;
  return static_cast<float>(pixel[0] + 2 * pixel[1] + pixel[2]);
}

// The middle of what is dark in the eye: across from its middle, and up from the line between its
// corners, in its widths.
std::optional<Vector2f> dark_middle(const cv::Mat& picture, const FaceLandmarks& face,
                                    const Eye& eye) {
  const auto at = [&](std::size_t i) -> Vector2f { return face.image_px[i].head<2>(); };
  const Vector2f across = at(eye.left) - at(eye.right);
  const float width = across.norm();
  if (!(width >= kLeastEye_px) || !std::isfinite(width)) return std::nullopt;
  const Vector2f x = across / width, up(x.y(), -x.x());
  const float top = (at(eye.upper) - at(eye.right)).dot(up);
  const float bottom = (at(eye.lower) - at(eye.right)).dot(up);
  if (!(top - bottom > kLeastGap * width)) return std::nullopt;
  struct Sample {
    Vector2f place;
    float brightness;
  };
  std::array<Sample, static_cast<std::size_t>(kAcross * kDown)> samples;
  std::size_t count = 0;
  float sum = 0.0f;
  for (int i = 0; i < kAcross; ++i) {
    const float s = (static_cast<float>(i) + 0.5f) / kAcross;
    // Lids are arches.
    const float arch = 1.0f - (2.0f * s - 1.0f) * (2.0f * s - 1.0f);
    for (int j = 0; j < kDown; ++j) {
      const float t = (static_cast<float>(j) + 0.5f) / kDown;
      const float height = arch * (bottom + t * (top - bottom));
      const Vector2f px = at(eye.right) + s * width * x + height * up;
      if (!(px.x() >= 0.0f && px.y() >= 0.0f && px.x() < static_cast<float>(picture.cols) &&
            px.y() < static_cast<float>(picture.rows)))
        return std::nullopt;
      samples[count] = {{s - 0.5f, height / width}, brightness(picture, px)};
      sum += samples[count++].brightness;
    }
  }
  const float mean = sum / static_cast<float>(count);
  Vector2f middle = Vector2f::Zero();
  float total = 0.0f;
  for (std::size_t i = 0; i < count; ++i) {
    const float darker = std::max(0.0f, mean - samples[i].brightness);
    middle += darker * darker * samples[i].place;
    total += darker * darker;
  }
  if (!(total > 0.0f)) return std::nullopt;
  return Vector2f(middle / total);
}

}  // namespace

std::optional<Vector2f> gaze_of(const cv::Mat& picture, const FaceLandmarks& face) {
  if (!face.found || picture.empty() || picture.type() != CV_8UC3) return std::nullopt;
  Vector2f sum = Vector2f::Zero();
  int eyes = 0;
  for (const Eye& eye : kEyes)
    if (const auto middle = dark_middle(picture, face, eye)) {
      sum += *middle;
      ++eyes;
    }
  if (eyes == 0) return std::nullopt;
  const auto angle = [&](float share) {
    return std::asin(
        std::clamp(kWidthInRadii * share / static_cast<float>(eyes), -kMostSine, kMostSine));
  };
  return Vector2f(angle(sum.x()), angle(sum.y()));
}

}  // namespace dance
