#include "producers/camera/files/image_reel.h"

#include <opencv2/imgcodecs.hpp>

#include "producers/camera/files/picture_file.h"

namespace dance {
namespace {

bool read_image(const std::string& path, cv::Mat& bgr) {
  try {
    bgr = cv::imread(path, cv::IMREAD_COLOR);
    return !bgr.empty();
  } catch (const cv::Exception&) {
    return false;
  }
}

}  // namespace

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
  cv::Mat first;
  if (!read_image(paths.front(), first)) {
    return fail(paths.front() + ": is damaged; fetch it again or leave it out");
  }
  std::unique_ptr<ImageReel> reel(new ImageReel);
  reel->paths_ = std::move(paths);
  reel->name_ = name;
  reel->hz_ = hz;
  reel->width_px_ = first.cols;
  reel->height_px_ = first.rows;
  return reel;
}

bool ImageReel::step() {
  if (next_ == paths_.size()) return false;
  ++next_;
  return true;
}

Duration ImageReel::time() const { return Duration::seconds(static_cast<double>(next_ - 1) / hz_); }

bool ImageReel::read(cv::Mat& bgr) { return read_image(paths_[next_ - 1], bgr); }

bool ImageReel::rewind() {
  next_ = 0;
  return true;
}

}  // namespace dance
