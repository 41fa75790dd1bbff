#include "apps/doctor/doctor_drawing.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstring>

#if DANCE_HAVE_VIEWER
#include "core/program/child_process.h"
#include "viewer/gl/offscreen.h"
#endif

namespace dance {

using Grade = Finding::Grade;

#if DANCE_HAVE_VIEWER
namespace {

// In the child: 0 and the renderer's name, or 1 and what is missing.
int try_context(int out) {
  // Drivers' messages on stderr are dropped.
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDERR_FILENO);
  const auto context = OffscreenContext::create();
  const std::string text = context ? renderer_name() : context.error().what;
  [[maybe_unused]] const auto written = write(out, text.data(), text.size());
  return context ? 0 : 1;
}

}  // namespace

Finding check_drawing() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return {"drawing", Grade::kNote, "cannot be tried", ""};
  auto child = ChildProcess::start_copy([&] { return try_context(ends[1]); });
  close(ends[1]);
  std::string text;
  std::array<char, 512> chunk;
  for (ssize_t n; (n = read(ends[0], chunk.data(), chunk.size())) > 0 && text.size() < 4096;)
    text.append(chunk.data(), static_cast<std::size_t>(n));
  close(ends[0]);
  const bool has_ended = child && child->wait(Duration::s(20));
  if (has_ended && child->ended_well()) return {"drawing", Grade::kOk, "OpenGL 3.3 by " + text, ""};
  if (has_ended && child->end_signal() != 0)
    text = std::string("the OpenGL driver ended by ") + strsignal(child->end_signal());
  return {"drawing", Grade::kProblem, text, "apt-get install libegl1 libgl1-mesa-dri libegl-mesa0"};
}
#else
Finding check_drawing() {
  return {"drawing", Grade::kNote, "built without the viewer: this house shows nothing",
          "apt-get install libglfw3-dev libepoxy-dev libimgui-dev libegl-dev"};
}
#endif

}  // namespace dance
