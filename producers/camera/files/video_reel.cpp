#include "producers/camera/files/video_reel.h"

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>

#include "formats/media/confined_decoders.h"
#include "formats/media/media_module.h"
#include "producers/camera/files/picture_file.h"

namespace dance {
namespace {

constexpr double kUsualHz = 30.0;
constexpr double kMostHz = 1000.0;
// What files say of their length is a little off in some formats.
constexpr double kCutOff = 0.95;

}  // namespace

Result<std::unique_ptr<VideoReel>> VideoReel::open(const std::string& path) {
  if (auto fine = check_file(path); !fine) return tl::make_unexpected(fine.error());
  std::unique_ptr<VideoReel> reel(new VideoReel);
  reel->path_ = path;
  reel->name_ = std::filesystem::path(path).filename();
  const auto module = media_module();
  if (!module)
    return fail(path + ": is no picture that can be read; if it is a video, " +
                module.error().what);
  if (const auto opened = reel->reopen(); !opened)
    return fail(path + ": is no picture that can be read; as a video: " + opened.error().what);
  const VideoFacts facts = reel->video_->facts();
  reel->hz_ = facts.hz > 0.0 && facts.hz <= kMostHz ? facts.hz : kUsualHz;
  reel->promised_ = facts.pictures;
  reel->encoding_ = facts.encoding;
  cv::Mat first;
  if (!reel->step() || !reel->read(first) || !reel->rewind()) {
    return fail(path + ": has no picture that can be read; try ffmpeg -i " + path + " dance.mp4");
  }
  // Turned as it is shown, which the header may not know.
  reel->width_px_ = first.cols;
  reel->height_px_ = first.rows;
  return reel;
}

bool VideoReel::step() {
  if (!video_->step()) return false;
  ++index_;
  const double at_s = video_->time_s().value_or(0.0);
  if (index_ == 0) first_s_ = at_s;
  const Duration said = Duration::seconds(std::isfinite(at_s) ? at_s - first_s_ : 0.0);
  const Duration period = Duration::period_of_hz(hz_);
  // Some files do not say, and some go back: then at the file's rate.
  const bool is_believable = said > time_ && said < time_ + Duration::s(3600);
  if (index_ > 0) time_ = is_believable ? said : time_ + period;
  return true;
}

bool VideoReel::read(cv::Mat& bgr) {
  const VideoSize size = video_->size();
  if (size.width_px < 1 || size.height_px < 1) return false;
  const int turn_deg = video_->facts().turn_deg;
  cv::Mat& to = turn_deg == 0 ? bgr : stored_;
  to.create(size.height_px, size.width_px, CV_8UC3);
  if (!video_->read({to.data, to.total() * to.elemSize()})) return false;
  if (turn_deg == 90) cv::rotate(to, bgr, cv::ROTATE_90_CLOCKWISE);
  if (turn_deg == 180) cv::rotate(to, bgr, cv::ROTATE_180);
  if (turn_deg == 270) cv::rotate(to, bgr, cv::ROTATE_90_COUNTERCLOCKWISE);
  return true;
}

// Opens the file again, as some formats cannot be wound back exactly.
Result<void> VideoReel::reopen() {
  index_ = -1;
  time_ = {};
  DANCE_TRY(const MediaModule* module, media_module());
  DANCE_TRY(video_, open_confined([&] { return module->open_video(path_); }));
  return {};
}

bool VideoReel::rewind() { return reopen().has_value(); }

bool VideoReel::is_cut_off() const {
  return promised_ > 0.0 && static_cast<double>(index_ + 1) < kCutOff * promised_;
}

}  // namespace dance
