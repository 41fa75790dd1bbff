// Encodes pictures into a video file with FFmpeg.
//
// Units/frames: as VideoEncoder.
// Ownership:    as VideoEncoder.
// Threads:      the encoder's own; one owner.
// Failure:      as VideoEncoder; create_video_file() says which formats this machine can write.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "formats/media/video_encoder.h"

namespace dance {

Result<std::unique_ptr<VideoEncoder>> create_video_file(const VideoWish& wish);

// "mp4 (libx264), webm (libvpx-vp9)", of what is made to be seen.
std::string encodable_formats();

}  // namespace dance
