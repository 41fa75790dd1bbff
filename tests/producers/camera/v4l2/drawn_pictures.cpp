#include "tests/producers/camera/v4l2/drawn_pictures.h"

#include <algorithm>
#include <opencv2/core.hpp>

#include "core/base/assert.h"
#include "producers/camera/files/bgr_picture.h"

namespace dance {
namespace {

struct Yuv {
  double y, u, v;
};

Yuv yuv_of(const cv::Vec3b& bgr) {
  const double b = bgr[0] / 255.0, g = bgr[1] / 255.0, r = bgr[2] / 255.0;
  const double y = 0.299 * r + 0.587 * g + 0.114 * b;
  return {16.0 + 219.0 * y, 128.0 + 224.0 * (b - y) / 1.772, 128.0 + 224.0 * (r - y) / 1.402};
}

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
}

}  // namespace

cv::Mat drawn_colours(int width_px, int height_px) {
  cv::Mat picture(height_px, width_px, CV_8UC3);
  const cv::Vec3d corners[4] = {{230, 30, 20}, {30, 210, 40}, {25, 35, 220}, {200, 200, 60}};
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      // A patch in each corner, and between them what lies between.
      const double right = std::clamp(3.0 * x / width_px - 1.0, 0.0, 1.0);
      const double down = std::clamp(3.0 * y / height_px - 1.0, 0.0, 1.0);
      const cv::Vec3d top = corners[0] * (1.0 - right) + corners[1] * right;
      const cv::Vec3d bottom = corners[2] * (1.0 - right) + corners[3] * right;
      picture.at<cv::Vec3b>(y, x) = top * (1.0 - down) + bottom * down;
    }
  }
  return picture;
}

cv::Mat drawn_grey(int width_px, int height_px, int level) {
  return cv::Mat(height_px, width_px, CV_8UC3, cv::Scalar::all(level));
}

std::vector<std::uint8_t> yuyv_of(const cv::Mat& bgr) {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; x += 2) {
      const Yuv a = yuv_of(bgr.at<cv::Vec3b>(y, x));
      const Yuv b = yuv_of(bgr.at<cv::Vec3b>(y, x + 1));
      for (const double value : {a.y, (a.u + b.u) / 2, b.y, (a.v + b.v) / 2}) {
        bytes.push_back(byte_of(value));
      }
    }
  }
  return bytes;
}

std::vector<std::uint8_t> nv12_of(const cv::Mat& bgr) {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) bytes.push_back(byte_of(yuv_of(bgr.at<cv::Vec3b>(y, x)).y));
  }
  for (int y = 0; y < bgr.rows; y += 2) {
    for (int x = 0; x < bgr.cols; x += 2) {
      double u = 0.0, v = 0.0;
      for (int i = 0; i < 4; ++i) {
        const Yuv one = yuv_of(bgr.at<cv::Vec3b>(y + i / 2, x + i % 2));
        u += one.u / 4;
        v += one.v / 4;
      }
      bytes.push_back(byte_of(u));
      bytes.push_back(byte_of(v));
    }
  }
  return bytes;
}

std::vector<std::uint8_t> jpeg_of(const cv::Mat& bgr) {
  auto bytes = jpeg_of_bgr(bgr, 90);
  DANCE_ASSERT(bytes.has_value());
  return std::move(*bytes);
}

double mean_difference(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return 1e9;
  return cv::norm(a, b, cv::NORM_L1) / (3.0 * static_cast<double>(a.total()));
}

double mean_level(const cv::Mat& picture) {
  const cv::Scalar mean = cv::mean(picture);
  return (mean[0] + mean[1] + mean[2]) / 3.0;
}

}  // namespace dance
