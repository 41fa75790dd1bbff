// Of a build without a viewer.
#include "headset/program/headset_run.h"

namespace dance {

Result<std::unique_ptr<HeadsetShow>> make_stereo_show(const HeadsetOptions&) {
  return fail(
      "this build shows nothing in a headset: build it with the viewer (libglfw3-dev and the "
      "others "
      "that configuring names), or dance with --tracking-only");
}

}  // namespace dance
