// VideoFile: pictures and their sound into an MP4, WebM or Matroska file, through the media module,
// by the best encoder that FFmpeg has for it: libx264, else libvpx-vp9, else mpeg4; AAC in MP4,
// else Opus.
//
// Units/frames: sRGB pictures of one size; an odd last row or column is left out. Sound is stereo
//               at kVideoSoundRate_hz.
// Ownership:    owns encoder and file; the file has the name path.part until finish().
// Threads:      none inside but the encoder's own; one owner.
// Failure:      create() says which formats this machine can write, or that the media module is
//               missing; nothing is overwritten. A file that was not finished is removed.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"
#include "viewer/gl/picture.h"

namespace dance {

class VideoFile {
 public:
  struct Format {
    int width_px = 0;
    int height_px = 0;
    double hz = 0.0;
    bool has_sound = false;
  };
  static Result<std::unique_ptr<VideoFile>> create(const std::string& path, const Format& format);
  virtual ~VideoFile() = default;

  virtual Result<void> add(const Picture& picture) = 0;
  // The sound of the picture that was added last. Needs a sound_encoder().
  virtual Result<void> add_sound(std::span<const float> stereo) = 0;
  virtual Result<void> finish() = 0;
  // For people: "libx264".
  virtual std::string encoder() const = 0;
  // "aac"; empty if the format has no sound, or FFmpeg has no encoder for it.
  virtual std::string sound_encoder() const = 0;
};

// "mp4 (libx264), webm (libvpx-vp9)", or why there are none.
std::string video_formats_here();

}  // namespace dance
