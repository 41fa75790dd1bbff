// PictureWindow: a window that shows pictures, fitted and centred.
//
// Units/frames: pictures blue green red, row 0 at the top.
// Ownership:    owns window and texture.
// Threads:      all calls from the thread that opened it.
// Failure:      open() says why there is none: no display, no OpenGL.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "core/base/result.h"

namespace dance {

class PictureWindow {
 public:
  static Result<std::unique_ptr<PictureWindow>> open(const std::string& title, int width_px,
                                                     int height_px);
  ~PictureWindow();
  PictureWindow(const PictureWindow&) = delete;
  PictureWindow& operator=(const PictureWindow&) = delete;

  void show(const cv::Mat& picture);
  // Handles what the user does; false once the window was closed.
  bool is_open();

 private:
  PictureWindow() = default;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace dance
