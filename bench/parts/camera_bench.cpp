// What does a camera's picture cost until it can be looked at, against OpenCV's plain conversion of
// the same bytes, or against how a JPEG file is read?
#include <benchmark/benchmark.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/base/assert.h"
#include "formats/picture/picture.h"
#include "producers/camera/files/bgr_picture.h"
#include "producers/camera/v4l2/picture_converter.h"

namespace dance {
namespace {

constexpr std::uint32_t fourcc(const char (&name)[5]) {
  return static_cast<std::uint32_t>(name[0]) | static_cast<std::uint32_t>(name[1]) << 8 |
         static_cast<std::uint32_t>(name[2]) << 16 | static_cast<std::uint32_t>(name[3]) << 24;
}

// As full of detail as a room with people: a JPEG of it has about two bits a pixel.
cv::Mat room_picture(int width_px, int height_px) {
  cv::RNG random(7);
  cv::Mat coarse(height_px / 16, width_px / 16, CV_8UC3), fine(height_px, width_px, CV_8UC3),
      picture;
  random.fill(coarse, cv::RNG::UNIFORM, 0, 256);
  random.fill(fine, cv::RNG::NORMAL, 0, 6);
  cv::resize(coarse, picture, fine.size(), 0, 0, cv::INTER_CUBIC);
  return picture + fine;
}

std::vector<std::uint8_t> room_jpeg(int width_px, int height_px) {
  auto jpeg = jpeg_of_bgr(room_picture(width_px, height_px), 80);
  DANCE_ASSERT(jpeg.has_value());
  return std::move(*jpeg);
}

PictureConverter converter_of(const PixelLayout& layout, int max_height_px = 0) {
  auto converter = PictureConverter::make(layout, max_height_px);
  DANCE_ASSERT(converter.has_value());
  return std::move(*converter);
}

void convert_all(benchmark::State& state, const PixelLayout& layout,
                 const std::vector<std::uint8_t>& bytes, int max_height_px = 0) {
  cv::setNumThreads(1);
  PictureConverter converter = converter_of(layout, max_height_px);
  cv::Mat picture;
  for (auto _ : state) {
    DANCE_ASSERT(converter.convert(bytes, picture));
    benchmark::DoNotOptimize(picture.data);
  }
}

// As a file of a picture is read.
void decode_all(benchmark::State& state, const std::vector<std::uint8_t>& jpeg) {
  cv::setNumThreads(1);
  constexpr PictureLimits kAsItIs{4096, std::size_t{1} << 26, 0};
  cv::Mat picture;
  for (auto _ : state) {
    auto read = read_picture(jpeg, kAsItIs);
    DANCE_ASSERT(read.has_value());
    cv::cvtColor(cv::Mat(read->height_px, read->width_px, CV_8UC4, read->rgba.data()), picture,
                 cv::COLOR_RGBA2BGR);
    benchmark::DoNotOptimize(picture.data);
  }
}

std::vector<std::uint8_t> noise(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  cv::Mat view(1, static_cast<int>(size), CV_8UC1, bytes.data());
  cv::RNG(7).fill(view, cv::RNG::UNIFORM, 0, 256);
  return bytes;
}

void yuyv_plain(benchmark::State& state) {
  cv::setNumThreads(1);
  std::vector<std::uint8_t> bytes = noise(1280 * 720 * 2);
  cv::Mat picture;
  for (auto _ : state) {
    cv::cvtColor(cv::Mat(720, 1280, CV_8UC2, bytes.data()), picture, cv::COLOR_YUV2BGR_YUY2);
    benchmark::DoNotOptimize(picture.data);
  }
}
BENCHMARK(yuyv_plain)->Name("camera: YUYV 1280x720/baseline");
void yuyv_ours(benchmark::State& state) {
  convert_all(state, {fourcc("YUYV"), 1280, 720, 0}, noise(1280 * 720 * 2));
}
BENCHMARK(yuyv_ours)->Name("camera: YUYV 1280x720/ours");

void nv12_plain(benchmark::State& state) {
  cv::setNumThreads(1);
  std::vector<std::uint8_t> bytes = noise(1280 * 1080);
  cv::Mat picture;
  for (auto _ : state) {
    cv::cvtColor(cv::Mat(1080, 1280, CV_8UC1, bytes.data()), picture, cv::COLOR_YUV2BGR_NV12);
    benchmark::DoNotOptimize(picture.data);
  }
}
BENCHMARK(nv12_plain)->Name("camera: NV12 1280x720/baseline");
void nv12_ours(benchmark::State& state) {
  convert_all(state, {fourcc("NV12"), 1280, 720, 0}, noise(1280 * 1080));
}
BENCHMARK(nv12_ours)->Name("camera: NV12 1280x720/ours");

void mjpg_plain(benchmark::State& state) { decode_all(state, room_jpeg(1280, 720)); }
BENCHMARK(mjpg_plain)->Name("camera: MJPG 1280x720/baseline");
void mjpg_ours(benchmark::State& state) {
  convert_all(state, {fourcc("MJPG"), 1280, 720, 0}, room_jpeg(1280, 720));
}
BENCHMARK(mjpg_ours)->Name("camera: MJPG 1280x720/ours");

void large_plain(benchmark::State& state) { decode_all(state, room_jpeg(3840, 2160)); }
BENCHMARK(large_plain)->Name("camera: MJPG 3840x2160/baseline");
void large_ours(benchmark::State& state) {
  convert_all(state, {fourcc("MJPG"), 3840, 2160, 0}, room_jpeg(3840, 2160));
}
BENCHMARK(large_ours)->Name("camera: MJPG 3840x2160/ours");
void large_half(benchmark::State& state) {
  convert_all(state, {fourcc("MJPG"), 3840, 2160, 0}, room_jpeg(3840, 2160), 1080);
}
BENCHMARK(large_half)->Name("camera: MJPG 3840x2160/ours at a half");

}  // namespace
}  // namespace dance
