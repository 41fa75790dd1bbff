// ImageReel: image files, in the order given.
//
// Units/frames: picture i is of i/hz.
// Ownership:    holds paths; a picture is read when it is asked for.
// Threads:      one owner.
// Failure:      open() names the file that is missing or no picture. One that turns out damaged
//               when it is read is skipped and counted by the player.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "producers/camera/files/picture_reel.h"

namespace dance {

class ImageReel : public PictureReel {
 public:
  static Result<std::unique_ptr<ImageReel>> open(std::vector<std::string> paths,
                                                 const std::string& name, double hz);

  bool step() override;
  Duration time() const override;
  bool read(cv::Mat& bgr) override;
  bool rewind() override;
  bool is_cut_off() const override { return false; }
  double hz() const override { return hz_; }
  int width_px() const override { return width_px_; }  // of the first; the others may differ
  int height_px() const override { return height_px_; }
  const std::string& encoding() const override { return encoding_; }
  const std::string& name() const override { return name_; }

 private:
  ImageReel() = default;

  std::vector<std::string> paths_;
  std::string name_;
  std::string encoding_ = "images";
  double hz_ = 0.0;
  int width_px_ = 0;
  int height_px_ = 0;
  std::size_t next_ = 0;
};

}  // namespace dance
