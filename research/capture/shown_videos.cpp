#include "research/capture/shown_videos.h"

#include <opencv2/core.hpp>

#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/files/picture_file.h"
#include "producers/camera/files/video_reel.h"

namespace dance {
namespace {

constexpr double kHeld_hz = 30.0;

}  // namespace

Result<VideoLandmarks> video_landmarks(const std::string& path) {
  DANCE_TRY(const auto estimator, PoseEstimator::open({}));
  DANCE_TRY(const auto reel, VideoReel::open(path));
  VideoLandmarks video;
  video.hz = reel->hz();
  video.camera = assumed_pinhole(reel->width_px(), reel->height_px());
  Frame frame;
  while (reel->step()) {
    if (!reel->read(frame.image)) return fail(path + ": a frame is damaged");
    frame.capture_time = MonoTime{} + Duration::s(1) + reel->time();
    estimator->estimate(frame);
    video.frames.push_back(estimator->unfiltered());
  }
  return video;
}

Result<VideoLandmarks> still_landmarks(const std::string& path, std::uint64_t index,
                                       std::size_t count, double noise) {
  DANCE_TRY(const auto estimator, PoseEstimator::open({}));
  DANCE_TRY(const auto reel, VideoReel::open(path));
  for (std::uint64_t i = 0; i <= index; ++i)
    if (!reel->step()) return fail(path + ": has no frame " + std::to_string(index));
  cv::Mat picture, noisy, grain;
  if (!reel->read(picture)) return fail(path + ": a frame is damaged");
  VideoLandmarks video;
  video.hz = kHeld_hz;
  video.camera = assumed_pinhole(reel->width_px(), reel->height_px());
  cv::RNG random(7);
  picture.convertTo(picture, CV_16SC3);
  grain.create(picture.size(), CV_16SC3);
  Frame frame;
  for (std::size_t i = 0; i < count; ++i) {
    random.fill(grain, cv::RNG::NORMAL, 0.0, noise);
    noisy = picture + grain;
    noisy.convertTo(frame.image, CV_8UC3);
    frame.capture_time = MonoTime{} + Duration::seconds(1.0 + static_cast<double>(i) / kHeld_hz);
    estimator->estimate(frame);
    video.frames.push_back(estimator->unfiltered());
  }
  return video;
}

}  // namespace dance
