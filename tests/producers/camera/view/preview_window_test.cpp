// The preview's window on a virtual display: what the dancer has on the screen.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "producers/camera/view/picture_window.h"
#include "producers/camera/view/preview.h"
#include "tests/test_folder.h"
#include "tests/viewer/driver_memory.h"
#include "tests/virtual_display.h"

namespace dance {
namespace {

// What is on the screen, by the dump that the server keeps: 25 words, a name, a table of colours,
// rows.
cv::Mat screen_of(const std::string& folder) {
  std::vector<std::uint8_t> bytes = bytes_in(folder + "/Xvfb_screen0");
  if (bytes.size() < 100) return {};
  const auto word = [&](std::size_t i) {
    std::size_t value = 0;
    for (std::size_t b = 0; b < 4; ++b) value = value << 8 | bytes[4 * i + b];
    return value;
  };
  constexpr std::size_t kHeadSize = 0, kWidth = 4, kHeight = 5, kBitsPerPixel = 11, kRowBytes = 12,
                        kColours = 19;
  const std::size_t begin = word(kHeadSize) + 12 * word(kColours);
  if (word(kBitsPerPixel) != 32 || bytes.size() < begin + word(kHeight) * word(kRowBytes))
    return {};
  const cv::Mat screen(static_cast<int>(word(kHeight)), static_cast<int>(word(kWidth)), CV_8UC4,
                       bytes.data() + begin, word(kRowBytes));
  cv::Mat colours;
  cv::cvtColor(screen, colours, cv::COLOR_BGRA2BGR);
  return colours;
}

// Four fields, each of a colour of its own; larger than the preview, which shrinks it.
Frame four_fields() {
  cv::Mat picture(720, 1280, CV_8UC3);
  picture(cv::Rect(0, 0, 640, 360)).setTo(cv::Scalar(200, 0, 0));
  picture(cv::Rect(640, 0, 640, 360)).setTo(cv::Scalar(0, 200, 0));
  picture(cv::Rect(0, 360, 640, 360)).setTo(cv::Scalar(0, 0, 200));
  picture(cv::Rect(640, 360, 640, 360)).setTo(cv::Scalar(200, 200, 200));
  return {picture, MonoTime::from_us(1), 1};
}

bool is_near(const cv::Mat& screen, int x, int y, const cv::Vec3b& colour) {
  return cv::norm(screen.at<cv::Vec3b>(y, x), colour, cv::NORM_INF) <= 12.0;
}

class PreviewWindow : public ::testing::Test {
 protected:
  PreviewWindow() {
    ::unsetenv("WAYLAND_DISPLAY");  // NOLINT(concurrency-mt-unsafe): one thread
  }

  static PreviewOptions in_a_window(bool is_mirrored = false) {
    PreviewOptions options;
    options.window = true;
    options.title = "alice before a test";
    options.is_mirrored = is_mirrored;
    return options;
  }
  // Whether the screen came to show these at the middles of its fields.
  bool comes_to_show(const PreviewOptions& options, const std::array<cv::Vec3b, 4>& fields) {
    const auto preview = Preview::open(options);
    if (!preview) {
      ADD_FAILURE() << preview.error().what;
      return false;
    }
    const Frame frame = four_fields();
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < give_up && (*preview)->trouble().empty()) {
      (*preview)->show(frame, {}, "alice, 30 Hz");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const cv::Mat screen = screen_of(folder_.path());
      // 640 x 360 in a window without a frame, in the corner, as nobody manages windows here.
      if (!screen.empty() && is_near(screen, 160, 90, fields[0]) &&
          is_near(screen, 480, 90, fields[1]) && is_near(screen, 160, 270, fields[2]) &&
          is_near(screen, 480, 270, fields[3])) {
        EXPECT_FALSE((*preview)->was_closed());
        return true;
      }
    }
    ADD_FAILURE() << "not seen on the screen; " << (*preview)->trouble();
    return false;
  }

  TestFolder folder_{"preview-window"};
};

TEST_F(PreviewWindow, SaysWhereThereIsNoDisplayAndTheWayOut) {
  ::unsetenv("DISPLAY");  // NOLINT(concurrency-mt-unsafe): one thread
  const auto preview = Preview::open(in_a_window());
  ASSERT_FALSE(preview);
  EXPECT_NE(preview.error().what.find("no display"), std::string::npos) << preview.error().what;
  EXPECT_NE(preview.error().what.find("--preview-file"), std::string::npos);
}

TEST_F(PreviewWindow, ShowsOnTheScreenWhatTheCameraSees) {
  const VirtualDisplay display(folder_.path());
  if (display.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  ::setenv("DISPLAY", display.display().c_str(), 1);  // NOLINT(concurrency-mt-unsafe): one thread
  {
    const auto window = PictureWindow::open("trial", 64, 64);
    if (!window) GTEST_SKIP() << window.error().what;
    keep_drivers_loaded();
  }
  const cv::Vec3b blue(200, 0, 0), green(0, 200, 0), red(0, 0, 200), white(200, 200, 200);
  EXPECT_TRUE(comes_to_show(in_a_window(), {blue, green, red, white}));
  EXPECT_TRUE(comes_to_show(in_a_window(true), {green, blue, white, red})) << "as in a mirror";
}

}  // namespace
}  // namespace dance
