// The media module: all that needs FFmpeg's libraries (songs that libsndfile cannot read, videos in
// and out), in a shared object that a program loads when the first such file comes. FFmpeg brings
// some ninety packages, which nobody needs to dance; Debian's dancegraph-media has the module and
// depends on them.
//
// The file is libdance_media.so (core/program/program_module.h). Its function
// dance_media_module_1() returns the table below.
//
// Units/frames: those of the three interfaces.
// Ownership:    the module stays loaded until the program ends; what it makes is the caller's.
// Threads:      any may call media_module().
// Failure:      media_module() says in one line what is missing and which Debian package brings it;
//               the next call tries again. Errors of the module's functions name the file unless
//               their interface says otherwise.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "formats/media/audio_decoder.h"
#include "formats/media/video_decoder.h"
#include "formats/media/video_encoder.h"

namespace dance {

struct MediaModule {
  Result<std::unique_ptr<AudioDecoder>> (*open_sound)(const std::string& path);
  Result<std::unique_ptr<VideoDecoder>> (*open_video)(const std::string& path);
  Result<std::unique_ptr<VideoEncoder>> (*create_video)(const VideoWish& wish);
  // What can be encoded to be seen: "mp4 (libx264), webm (libvpx-vp9)".
  std::string (*video_formats)();
};

Result<const MediaModule*> media_module();

// The same from another file than the program's own; for tests of damaged installations.
Result<const MediaModule*> media_module_from(const std::string& path);

}  // namespace dance

extern "C" const void* dance_media_module_1(const char* interface_hash);
