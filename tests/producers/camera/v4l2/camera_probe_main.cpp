// dance-camera-probe: opens a source of pictures as `dance capture` does, takes some and says what
// came. For tests that cannot link into a process of their own: a preloaded camera, a kernel in a
// virtual machine.
#include <cstdio>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <string>

#include "core/net/mono_clock.h"
#include "producers/camera/files/open_frame_source.h"
#include "producers/camera/v4l2/camera_list.h"
#include "tests/producers/camera/v4l2/press_control.h"

namespace dance {
namespace {

constexpr Duration kFrameTimeout = Duration::ms(500);

void print(const FrameSource& source) {
  const FrameCounters& c = source.counters();
  std::printf("taken %llu outrun %llu lost %llu damaged %llu unplugged %llu\n",
              static_cast<unsigned long long>(c.taken), static_cast<unsigned long long>(c.outrun),
              static_cast<unsigned long long>(c.lost), static_cast<unsigned long long>(c.damaged),
              static_cast<unsigned long long>(c.unplugged));
}

enum class WhenGone { kEnd, kGoOn, kCountAnew };

// Until `wanted` pictures came (kCountAnew: came after it was unplugged and back), the file ended,
// or time is over.
int probe(const std::string& called, const SourceOptions& options, int wanted, WhenGone when_gone,
          double seconds) {
  auto source = open_frame_source(called, options);
  if (!source) {
    std::fprintf(stderr, "%s\n", source.error().what.c_str());
    return 1;
  }
  std::printf("%s\n", line_on(**source).c_str());
  const MonoTime end = mono_now() + Duration::seconds(seconds);
  Frame frame;
  Duration oldest;
  bool was_gone = false;
  int taken = 0;
  bool counts = when_gone != WhenGone::kCountAnew;
  while ((!counts || taken < wanted) && mono_now() < end) {
    switch ((*source)->next(kFrameTimeout, frame)) {
      case FrameState::kFrame: {
        const cv::Scalar mean = cv::mean(frame.image);
        const Duration age = mono_now() - frame.capture_time;
        if (age > oldest) oldest = age;
        if (taken++ == 0 || was_gone || taken == wanted) {
          std::printf("picture %d: %dx%d sequence %llu blue %.0f green %.0f red %.0f\n", taken,
                      frame.image.cols, frame.image.rows,
                      static_cast<unsigned long long>(frame.sequence), mean[0], mean[1], mean[2]);
        }
        was_gone = false;
        break;
      }
      case FrameState::kNone:
        break;
      case FrameState::kGone:
        if (!was_gone) std::printf("gone\n");
        was_gone = true;
        if (when_gone == WhenGone::kEnd) {
          print(**source);
          return 0;
        }
        break;
      case FrameState::kBack:
        std::printf("back\n");
        if (!counts) taken = 0;
        counts = true;
        break;
      case FrameState::kOver:
        std::printf("over\n");
        print(**source);
        return 0;
    }
    std::fflush(stdout);
  }
  print(**source);
  std::printf("oldest %.1f ms\n", oldest.as_ms());
  return counts && taken == wanted ? 0 : 1;
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "--list") {
    std::fputs(dance::camera_table(dance::list_cameras()).c_str(), stdout);
    return 0;
  }
  if (argc == 5 && std::string(argv[1]) == "--press") {
    return dance::press_control(argv[2], argv[3], std::atoi(argv[4])) ? 0 : 1;
  }
  if (argc < 4) {
    std::fprintf(
        stderr,
        "camera_probe SOURCE PICTURES SECONDS [wait|back] [WIDTHxHEIGHT] [ENCODING] | --list | "
        "--press DEVICE BUTTON VALUE\n");
    return 2;
  }
  dance::SourceOptions options;
  dance::WhenGone when_gone = dance::WhenGone::kEnd;
  for (int i = 4; i < argc; ++i) {
    const std::string word = argv[i];
    int width_px = 0, height_px = 0;
    if (word == "wait") {
      when_gone = dance::WhenGone::kGoOn;
    } else if (word == "back") {
      when_gone = dance::WhenGone::kCountAnew;
    } else if (std::sscanf(argv[i], "%dx%d", &width_px, &height_px) == 2) {
      options.camera.width_px = width_px;
      options.camera.height_px = height_px;
    } else {
      options.camera.encoding = word;
    }
  }
  return dance::probe(argv[1], options, std::atoi(argv[2]), when_gone, std::atof(argv[3]));
}
