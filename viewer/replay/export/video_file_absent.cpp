#include "viewer/replay/export/video_file.h"

namespace dance {

Result<std::unique_ptr<VideoFile>> VideoFile::create(const std::string& path, int, int, double) {
  return fail(path +
              ": this build writes no video; export a folder of pictures instead, or install "
              "libavformat-dev libavcodec-dev libswscale-dev and build again");
}

std::string video_formats_here() { return "none: built without FFmpeg's libraries"; }

}  // namespace dance
