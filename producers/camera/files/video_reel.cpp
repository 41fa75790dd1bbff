#include "producers/camera/files/video_reel.h"

#include <cmath>
#include <filesystem>

#include "producers/camera/files/picture_file.h"

namespace dance {
namespace {

constexpr double kUsualHz = 30.0;
constexpr double kMostHz = 1000.0;
// What files say of their length is a little off in some formats.
constexpr double kCutOff = 0.95;

std::string codec_of(double code) {
  std::string text;
  for (auto rest = static_cast<std::uint32_t>(code); rest != 0; rest >>= 8) {
    const char c = static_cast<char>(rest & 0xff);
    text += c > ' ' && c <= '~' ? c : '?';
  }
  return text.empty() ? "video" : text;
}

}  // namespace

Result<std::unique_ptr<VideoReel>> VideoReel::open(const std::string& path) {
  if (auto fine = check_file(path); !fine) return tl::make_unexpected(fine.error());
  std::unique_ptr<VideoReel> reel(new VideoReel);
  reel->path_ = path;
  reel->name_ = std::filesystem::path(path).filename();
  cv::VideoCapture& video = reel->video_;
  // FFmpeg by name: left to choose, OpenCV would take "a12.txt" for the twelfth picture of a
  // series.
  if (!video.open(path, cv::CAP_FFMPEG)) {
    return fail(path +
                ": is neither a video nor a picture that can be read; make it one with ffmpeg -i " +
                path + " dance.mp4");
  }
  reel->width_px_ = static_cast<int>(video.get(cv::CAP_PROP_FRAME_WIDTH));
  reel->height_px_ = static_cast<int>(video.get(cv::CAP_PROP_FRAME_HEIGHT));
  const double hz = video.get(cv::CAP_PROP_FPS);
  reel->hz_ = std::isfinite(hz) && hz > 0.0 && hz <= kMostHz ? hz : kUsualHz;
  reel->promised_ = video.get(cv::CAP_PROP_FRAME_COUNT);
  reel->encoding_ = codec_of(video.get(cv::CAP_PROP_FOURCC));
  cv::Mat first;
  if (!video.grab() || !video.retrieve(first) || first.empty() || !reel->rewind()) {
    return fail(path + ": has no picture that can be read; try ffmpeg -i " + path + " dance.mp4");
  }
  // Turned as it is shown, which the header may not know.
  reel->width_px_ = first.cols;
  reel->height_px_ = first.rows;
  return reel;
}

bool VideoReel::step() {
  if (!video_.grab()) return false;
  ++index_;
  const double ms = video_.get(cv::CAP_PROP_POS_MSEC);
  if (index_ == 0) first_ms_ = ms;
  const Duration said = Duration::seconds(std::isfinite(ms) ? (ms - first_ms_) / 1000.0 : 0.0);
  const Duration period = Duration::period_of_hz(hz_);
  // Some files do not say, and some go back: then at the file's rate.
  const bool is_believable = said > time_ && said < time_ + Duration::s(3600);
  if (index_ > 0) time_ = is_believable ? said : time_ + period;
  return true;
}

bool VideoReel::read(cv::Mat& bgr) {
  try {
    return video_.retrieve(bgr) && bgr.type() == CV_8UC3;
  } catch (const cv::Exception&) {
    return false;
  }
}

bool VideoReel::rewind() {
  index_ = -1;
  time_ = {};
  // Reopened: not every format can be wound back exactly.
  return video_.open(path_, cv::CAP_FFMPEG);
}

bool VideoReel::is_cut_off() const {
  return promised_ > 0.0 && static_cast<double>(index_ + 1) < kCutOff * promised_;
}

}  // namespace dance
