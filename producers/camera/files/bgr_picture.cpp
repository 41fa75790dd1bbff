#include "producers/camera/files/bgr_picture.h"

#include <opencv2/imgproc.hpp>

#include "core/program/whole_file.h"
#include "formats/picture/jpeg_writer.h"
#include "formats/picture/orientation.h"
#include "formats/picture/picture.h"
#include "formats/picture/png_writer.h"

namespace dance {
namespace {

constexpr std::size_t kMostPictureFile_bytes = std::size_t{1} << 28;
// A camera's photographs are larger than what an avatar wears, and are not made smaller here.
constexpr PictureLimits kPhotographLimits{16384, std::size_t{1} << 28, 0};

void set_upright(cv::Mat& picture, int orientation) {
  constexpr int kFirstTransposed = 5;
  constexpr int kBoth = -1, kRows = 0, kColumns = 1;
  if (orientation >= kFirstTransposed) cv::transpose(picture, picture);
  if (orientation == 2 || orientation == 6) cv::flip(picture, picture, kColumns);
  if (orientation == 3 || orientation == 7) cv::flip(picture, picture, kBoth);
  if (orientation == 4 || orientation == 8) cv::flip(picture, picture, kRows);
}

// Its rows one behind the other.
Result<cv::Mat> rgb_of(const cv::Mat& bgr) {
  if (bgr.empty() || bgr.type() != CV_8UC3) return fail("no picture of three bytes a pixel");
  cv::Mat rgb;
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return rgb;
}

std::span<const std::uint8_t> pixels_of(const cv::Mat& rgb) {
  return {rgb.data, rgb.total() * rgb.elemSize()};
}

}  // namespace

Result<cv::Mat> read_bgr_picture(const std::string& path) {
  DANCE_TRY(const std::string file, read_whole_file(path, kMostPictureFile_bytes));
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
  auto picture = read_picture(bytes, kPhotographLimits);
  if (!picture) {
    const std::string& what = picture.error().what;
    const bool has_cure = what.find(';') != std::string::npos;
    return fail(path + ": " + what + (has_cure ? "" : "; fetch it again or leave it out"));
  }
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(picture->height_px, picture->width_px, CV_8UC4, picture->rgba.data()), bgr,
               cv::COLOR_RGBA2BGR);
  set_upright(bgr, exif_orientation(bytes));
  return bgr;
}

Result<std::vector<std::uint8_t>> jpeg_of_bgr(const cv::Mat& bgr, int quality) {
  DANCE_TRY(const cv::Mat rgb, rgb_of(bgr));
  return jpeg_of_rgb(rgb.cols, rgb.rows, pixels_of(rgb), quality);
}

Result<std::vector<std::uint8_t>> png_of_bgr(const cv::Mat& bgr) {
  DANCE_TRY(const cv::Mat rgb, rgb_of(bgr));
  return png_of_rgb(rgb.cols, rgb.rows, pixels_of(rgb));
}

}  // namespace dance
