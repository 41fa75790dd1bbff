// In a build without GLFW there is no window.
#include "producers/camera/view/picture_window.h"

namespace dance {

struct PictureWindow::Parts {};

Result<std::unique_ptr<PictureWindow>> PictureWindow::open(const std::string&, int, int) {
  return fail(
      "this build has no window for the preview: libglfw3-dev and libepoxy-dev were not there; "
      "--preview-file FILE.jpg writes "
      "it as a picture instead");
}
PictureWindow::~PictureWindow() = default;
void PictureWindow::show(const cv::Mat&) {}
bool PictureWindow::is_open() { return false; }

}  // namespace dance
