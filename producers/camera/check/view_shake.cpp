#include "producers/camera/check/view_shake.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/median.h"

namespace dance {
namespace {

constexpr int kBlock_px = 16;
constexpr int kReach_px = 6;          // how far a block is looked for
constexpr double kFewestDetails = 5;  // standard deviation of a block's luma
constexpr std::size_t kFewestBlocks = 6;
constexpr float kNewer = 0.6f;  // weight of a new value
// A shift has to be so much better than none: noise has no direction.
constexpr double kBetter = 0.7;
constexpr double kNoise = 2.0;  // levels of 255 a pixel

bool is_of_the_body(const cv::Rect& block, const cv::Size& picture, const SeenBody2d& body) {
  if (!body.is_found) return false;
  float left = 1.0f;
  float right = 0.0f;
  for (const SeenPoint& p : body.points) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
  }
  const auto width = static_cast<float>(picture.width);
  return static_cast<float>(block.x + block.width) > (left - 0.05f) * width &&
         static_cast<float>(block.x) < (right + 0.05f) * width;
}

// Of two blocks of the same size, beside their difference in brightness.
double difference(const cv::Mat& a, const cv::Mat& b) {
  const double brighter = cv::mean(a)[0] - cv::mean(b)[0];
  double sum = 0.0;
  for (int y = 0; y < a.rows; ++y) {
    const std::uint8_t* p = a.ptr<std::uint8_t>(y);
    const std::uint8_t* q = b.ptr<std::uint8_t>(y);
    for (int x = 0; x < a.cols; ++x) sum += std::abs(p[x] - q[x] - brighter);
  }
  return sum;
}

cv::Point shift_of(const cv::Mat& before, const cv::Mat& now, const cv::Rect& block) {
  const cv::Mat wanted = before(block);
  const double at_rest = difference(wanted, now(block));
  if (at_rest < kNoise * block.area()) return {0, 0};
  double best = at_rest;
  cv::Point shift(0, 0);
  for (int dy = -kReach_px; dy <= kReach_px; ++dy)
    for (int dx = -kReach_px; dx <= kReach_px; ++dx) {
      const double found = difference(wanted, now(block + cv::Point(dx, dy)));
      if (found >= best) continue;
      best = found;
      shift = {dx, dy};
    }
  return best < kBetter * at_rest ? shift : cv::Point(0, 0);
}

}  // namespace

void ViewShake::reset() {
  reference_.release();
  shake_ = 0.0f;
}

float ViewShake::shift_px(const cv::Mat& before, const cv::Mat& now, const SeenBody2d& body) {
  across_.clear();
  down_.clear();
  for (int y = kReach_px; y + kBlock_px + kReach_px <= now.rows; y += kBlock_px)
    for (int x = kReach_px; x + kBlock_px + kReach_px <= now.cols; x += kBlock_px) {
      const cv::Rect block(x, y, kBlock_px, kBlock_px);
      if (is_of_the_body(block, now.size(), body)) continue;
      cv::Scalar mean;
      cv::Scalar deviation;
      cv::meanStdDev(before(block), mean, deviation);
      if (deviation[0] < kFewestDetails) continue;
      const cv::Point shift = shift_of(before, now, block);
      across_.push_back(shift.x);
      down_.push_back(shift.y);
    }
  if (across_.size() < kFewestBlocks) return 0.0f;
  return std::hypot(static_cast<float>(median_of<int>(across_)),
                    static_cast<float>(median_of<int>(down_)));
}

float ViewShake::see(const cv::Mat& luma, const SeenBody2d& body, MonoTime time) {
  const bool is_first = reference_.empty();
  if (!is_first && time - reference_time_ < kEvery) return shake_;
  const int height = std::max(1, luma.rows * kWidth_px / std::max(1, luma.cols));
  cv::resize(luma, small_, {kWidth_px, height}, 0, 0, cv::INTER_AREA);
  if (!is_first && small_.size() == reference_.size()) {
    const auto seconds = static_cast<float>((time - reference_time_).as_seconds());
    const float speed = shift_px(reference_, small_, body) / kWidth_px / seconds;
    shake_ += kNewer * (speed - shake_);
  }
  cv::swap(small_, reference_);
  reference_time_ = time;
  return shake_;
}

}  // namespace dance
