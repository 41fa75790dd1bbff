#include "producers/camera/files/image_reel.h"

#include "producers/camera/files/bgr_picture.h"
#include "producers/camera/files/picture_file.h"

namespace dance {

Result<std::unique_ptr<ImageReel>> ImageReel::open(std::vector<std::string> paths,
                                                   const std::string& name, double hz) {
  if (paths.empty()) return fail("no pictures given; name at least one");
  for (const std::string& path : paths) {
    if (auto fine = check_file(path); !fine) return tl::make_unexpected(fine.error());
    if (!is_picture(path)) {
      return fail(path +
                  ": is no picture that can be read; make it a .png or .jpg, or leave it out");
    }
  }
  const auto first = read_bgr_picture(paths.front());
  if (!first) return tl::make_unexpected(first.error());
  std::unique_ptr<ImageReel> reel(new ImageReel);
  reel->paths_ = std::move(paths);
  reel->name_ = name;
  reel->hz_ = hz;
  reel->width_px_ = first->cols;
  reel->height_px_ = first->rows;
  return reel;
}

bool ImageReel::step() {
  if (next_ == paths_.size()) return false;
  ++next_;
  return true;
}

Duration ImageReel::time() const { return Duration::seconds(static_cast<double>(next_ - 1) / hz_); }

bool ImageReel::read(cv::Mat& bgr) {
  auto picture = read_bgr_picture(paths_[next_ - 1]);
  if (picture) bgr = std::move(*picture);
  return picture.has_value();
}

bool ImageReel::rewind() {
  next_ = 0;
  return true;
}

}  // namespace dance
