// Files of pictures and videos for tests, and the pictures in them again.
//
// Units/frames: as Frame: blue, green, red.
// Ownership:    the caller's.
// Threads:      none inside.
// Failure:      a test that cannot have its material fails.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/program/whole_file.h"
#include "formats/media/media_module.h"
#include "producers/camera/files/bgr_picture.h"
#include "producers/camera/files/video_reel.h"

namespace dance {

// A .png, or a .jpg by its name.
inline void write_picture(const std::string& path, const cv::Mat& bgr) {
  const auto bytes = path.ends_with(".jpg") ? jpeg_of_bgr(bgr) : png_of_bgr(bgr);
  ASSERT_TRUE(bytes) << bytes.error().what;
  const auto written = write_whole_file(path, *bytes);
  ASSERT_TRUE(written) << written.error().what;
}

inline cv::Mat grey_picture(const std::string& path) {
  const auto bgr = read_bgr_picture(path);
  if (!bgr) {
    ADD_FAILURE() << bgr.error().what;
    return {};
  }
  cv::Mat grey;
  cv::cvtColor(*bgr, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

// Motion JPEG in Matroska, of as many pictures as asked for.
inline void write_video(const std::string& path, double hz, int pictures, cv::Size size,
                        const std::function<cv::Mat(int)>& picture) {
  const auto module = media_module();
  ASSERT_TRUE(module) << module.error().what;
  VideoWish wish;
  wish.path = wish.name = path;
  wish.use = VideoUse::kToBeMeasured;
  wish.order = PixelOrder::kBgr;
  wish.width_px = size.width;
  wish.height_px = size.height;
  wish.hz = hz;
  const auto video = (*module)->create_video(wish);
  ASSERT_TRUE(video) << video.error().what;
  for (int i = 0; i < pictures; ++i) {
    const cv::Mat bgr = picture(i);
    const auto added = (*video)->add({bgr.data, bgr.total() * bgr.elemSize()});
    ASSERT_TRUE(added) << added.error().what;
  }
  const auto finished = (*video)->finish();
  ASSERT_TRUE(finished) << finished.error().what;
}

// The pictures of a video, one behind the other.
class VideoPictures {
 public:
  explicit VideoPictures(const std::string& path) {
    auto reel = VideoReel::open(path);
    if (reel) reel_ = std::move(*reel);
  }
  bool is_open() const { return reel_ != nullptr; }
  double hz() const { return reel_ ? reel_->hz() : 0.0; }
  bool next(cv::Mat& bgr) { return reel_ && reel_->step() && reel_->read(bgr); }

 private:
  std::unique_ptr<VideoReel> reel_;
};

}  // namespace dance

#define SKIP_WITHOUT_MEDIA()                                \
  if (const auto media = ::dance::media_module(); !media) { \
    GTEST_SKIP() << media.error().what;                     \
  }
