// VideoFile: pictures into an MP4, WebM or Matroska file, through the media module, by the best
// encoder that FFmpeg has for it: libx264, else libvpx-vp9, else mpeg4.
//
// Units/frames: sRGB pictures of one size; an odd last row or column is left out.
// Ownership:    owns encoder and file; the file has the name path.part until finish().
// Threads:      none inside but the encoder's own; one owner.
// Failure:      create() says which formats this machine can write, or that the media module is
//               missing; nothing is overwritten. A file that was not finished is removed.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "viewer/gl/picture.h"

namespace dance {

class VideoFile {
 public:
  static Result<std::unique_ptr<VideoFile>> create(const std::string& path, int width_px,
                                                   int height_px, double hz);
  virtual ~VideoFile() = default;

  virtual Result<void> add(const Picture& picture) = 0;
  virtual Result<void> finish() = 0;
  // For people: "libx264".
  virtual std::string encoder() const = 0;
};

// "mp4 (libx264), webm (libvpx-vp9)", or why there are none.
std::string video_formats_here();

}  // namespace dance
