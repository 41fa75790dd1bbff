// VideoReel: a video file, through the media module (FFmpeg).
//
// Units/frames: as PictureReel.
// Ownership:    owns the decoder.
// Threads:      one owner; FFmpeg decodes on threads of its own.
// Failure:      open() names the file, the reason and the cure, also where the module is missing. A
//               file that is cut off ends earlier, and is_cut_off().
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "formats/media/video_decoder.h"
#include "producers/camera/files/picture_reel.h"

namespace dance {

class VideoReel : public PictureReel {
 public:
  static Result<std::unique_ptr<VideoReel>> open(const std::string& path);

  bool step() override;
  Duration time() const override { return time_; }
  bool read(cv::Mat& bgr) override;
  bool rewind() override;
  bool is_cut_off() const override;
  double hz() const override { return hz_; }
  int width_px() const override { return width_px_; }
  int height_px() const override { return height_px_; }
  const std::string& encoding() const override { return encoding_; }
  const std::string& name() const override { return name_; }

 private:
  VideoReel() = default;
  Result<void> reopen();

  std::unique_ptr<VideoDecoder> video_;
  std::string path_;
  std::string name_;
  std::string encoding_;
  double hz_ = 0.0;
  int width_px_ = 0;
  int height_px_ = 0;
  double promised_ = 0.0;  // pictures, as the file says
  std::int64_t index_ = -1;
  double first_s_ = 0.0;
  cv::Mat stored_;  // as the file has it, before it is turned
  Duration time_;
};

}  // namespace dance
