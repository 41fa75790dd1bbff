#include "producers/camera/check/picture_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

namespace dance {
namespace {

constexpr int kWhite = 250;
constexpr int kFewest_px = 12;  // of a part, to say how bright it is
constexpr std::array<std::size_t, 5> kFacePoints{2, 5, 7, 8, 9};
constexpr std::array<std::size_t, 4> kTorsoPoints{11, 12, 23, 24};

// The part of the picture that these points span, `more` wider on each side.
template <class Points>
cv::Rect spanned(const cv::Mat& picture, const SeenBody2d& body, const Points& points, float more) {
  float left = 1.0f;
  float right = 0.0f;
  float top = 1.0f;
  float bottom = 0.0f;
  for (const std::size_t i : points) {
    left = std::min(left, body.points[i].x);
    right = std::max(right, body.points[i].x);
    top = std::min(top, body.points[i].y);
    bottom = std::max(bottom, body.points[i].y);
  }
  const auto at = [](float share, int size) {
    return static_cast<int>(std::lround(std::clamp(share, 0.0f, 1.0f) * static_cast<float>(size)));
  };
  const int x0 = at(left - more, picture.cols);
  const int x1 = at(right + more, picture.cols);
  const int y0 = at(top - more, picture.rows);
  const int y1 = at(bottom + more, picture.rows);
  return {x0, y0, std::max(0, x1 - x0), std::max(0, y1 - y0)};
}

std::array<std::size_t, kSeenPoints> all_points() {
  std::array<std::size_t, kSeenPoints> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

double sum_of(const cv::Mat& luma, const cv::Rect& part) { return cv::sum(luma(part))[0]; }

// The better lit of face and torso: clothes may be black.
float body_luma(const cv::Mat& luma, const SeenBody2d& body, float otherwise) {
  float best = -1.0f;
  for (const cv::Rect& part :
       {spanned(luma, body, kFacePoints, 0.0f), spanned(luma, body, kTorsoPoints, 0.0f)})
    if (part.area() >= kFewest_px)
      best = std::max(best, static_cast<float>(sum_of(luma, part) / part.area() / 255.0));
  return best < 0.0f ? otherwise : best;
}

}  // namespace

PictureLight light_of(const cv::Mat& luma, const SeenBody2d& body) {
  PictureLight light;
  if (luma.empty()) return light;
  std::array<int, 256> histogram{};
  for (int y = 0; y < luma.rows; ++y) {
    const std::uint8_t* row = luma.ptr<std::uint8_t>(y);
    for (int x = 0; x < luma.cols; ++x) ++histogram[row[x]];
  }
  const int all = luma.rows * luma.cols;
  const auto percentile = [&](int percent) {
    int below = 0;
    for (int value = 0; value < 256; ++value)
      if ((below += histogram[static_cast<std::size_t>(value)]) * 100 >= percent * all)
        return value;
    return 255;
  };
  double sum = 0.0;
  int white = 0;
  for (int value = 0; value < 256; ++value) {
    sum += static_cast<double>(value) * histogram[static_cast<std::size_t>(value)];
    if (value >= kWhite) white += histogram[static_cast<std::size_t>(value)];
  }
  light.mean = static_cast<float>(sum / all / 255.0);
  light.spread = static_cast<float>(percentile(95) - percentile(5)) / 255.0f;
  light.white_share = static_cast<float>(white) / static_cast<float>(all);
  light.body = light.around = light.mean;
  if (!body.is_found) return light;
  const cv::Rect whole = spanned(luma, body, all_points(), 0.03f);
  const int around = all - whole.area();
  if (around < all / 10) return light;  // the body fills the picture
  light.around = static_cast<float>((sum - sum_of(luma, whole)) / around / 255.0);
  light.body = body_luma(luma, body, light.around);
  return light;
}

}  // namespace dance
