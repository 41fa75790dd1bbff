#include "producers/camera/view/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

namespace dance {
namespace {

using enum Landmark;
struct Limb {
  Landmark from;
  Landmark to;
};
constexpr Limb kLimbs[] = {{kLeftShoulder, kRightShoulder},
                           {kLeftHip, kRightHip},
                           {kLeftShoulder, kLeftHip},
                           {kRightShoulder, kRightHip},
                           {kLeftShoulder, kLeftElbow},
                           {kLeftElbow, kLeftWrist},
                           {kRightShoulder, kRightElbow},
                           {kRightElbow, kRightWrist},
                           {kLeftWrist, kLeftIndex},
                           {kRightWrist, kRightIndex},
                           {kLeftHip, kLeftKnee},
                           {kLeftKnee, kLeftAnkle},
                           {kRightHip, kRightKnee},
                           {kRightKnee, kRightAnkle},
                           {kLeftAnkle, kLeftHeel},
                           {kLeftHeel, kLeftFootIndex},
                           {kLeftAnkle, kLeftFootIndex},
                           {kRightAnkle, kRightHeel},
                           {kRightHeel, kRightFootIndex},
                           {kRightAnkle, kRightFootIndex},
                           {kLeftEar, kLeftEye},
                           {kLeftEye, kNose},
                           {kNose, kRightEye},
                           {kRightEye, kRightEar}};

constexpr float kFar_px = 20000.0f;  // far outside of any picture, and whole in an int
constexpr float kSeen = 0.5f;        // visibility from which a point is drawn in full

cv::Scalar colour_of(Landmark from, Landmark to) {
  // Left points have odd numbers from the shoulders on, 1…3 and 7 in the face.
  const auto is_left = [](Landmark l) {
    const std::size_t i = index_of(l);
    return i >= index_of(kLeftShoulder) ? i % 2 == 1 : (i >= 1 && i <= 3) || i == 7;
  };
  const auto is_middle = [](Landmark l) { return l == kNose; };
  const bool left = (is_left(from) || is_middle(from)) && (is_left(to) || is_middle(to));
  const bool right = !is_left(from) && !is_left(to);
  if (left) return {60, 160, 255};
  if (right) return {255, 190, 60};
  return {235, 235, 235};
}

cv::Point pixel_of(const Eigen::Vector3f& image_px) {
  const auto whole = [](float v) {
    return std::isfinite(v) ? static_cast<int>(std::lround(std::clamp(v, -kFar_px, kFar_px)))
                            : -20000;
  };
  return {whole(image_px.x()), whole(image_px.y())};
}

}  // namespace

void draw_landmarks(cv::Mat& picture, const BodyLandmarks& body) {
  if (!body.found) return;
  const int width = std::max(1, static_cast<int>(std::lround(body.region.side_px / 160.0f)));
  for (const Limb& limb : kLimbs) {
    const float seen = std::min(body.visible(limb.from), body.visible(limb.to));
    cv::Scalar colour = colour_of(limb.from, limb.to);
    if (seen < kSeen) colour = colour * 0.45;
    cv::line(picture, pixel_of(body.image(limb.from)), pixel_of(body.image(limb.to)), colour,
             seen < kSeen ? 1 : width + 1, cv::LINE_AA);
  }
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const auto landmark = static_cast<Landmark>(i);
    // A face is as wide as three of these dots: its nose will do.
    const bool is_face = landmark > kNose && landmark < kLeftShoulder;
    if (is_face || body.visible(landmark) < kSeen) continue;
    cv::circle(picture, pixel_of(body.image(landmark)), width + 1, {255, 255, 255}, cv::FILLED,
               cv::LINE_AA);
  }
}

void draw_board(cv::Mat& picture, int columns, int rows, const std::vector<cv::Point2f>& corners) {
  if (!corners.empty()) cv::drawChessboardCorners(picture, {columns, rows}, corners, true);
}

void draw_caption(cv::Mat& picture, std::string_view text) {
  const double size = std::max(0.35, picture.cols / 1600.0);
  const int height = static_cast<int>(std::lround(42.0 * size));
  if (picture.rows <= height) return;
  cv::Mat band = picture.rowRange(picture.rows - height, picture.rows);
  band.convertTo(band, -1, 0.35);
  cv::putText(picture, std::string(text),
              {static_cast<int>(10 * size), picture.rows - static_cast<int>(14 * size)},
              cv::FONT_HERSHEY_SIMPLEX, size, {240, 240, 240}, 1, cv::LINE_AA);
}

}  // namespace dance
