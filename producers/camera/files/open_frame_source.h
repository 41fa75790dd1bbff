// Opens a source of pictures by the name that a person gives.
//
// Units/frames: as FrameSource.
// Ownership:    the source is the caller's.
// Threads:      none inside.
// Failure:      names the thing, the reason and the cure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "producers/camera/files/played_reel.h"
#include "producers/camera/frame_source.h"
#include "producers/camera/v4l2/video_mode.h"

namespace dance {

struct SourceOptions {
  CameraWish camera;
  PlayOptions play;
};

// "" or "auto": the first camera. "/dev/video0", "0": that camera. A file: a video or a picture. A
// folder: its pictures. "a.jpg,b.jpg": these pictures. Else a camera of that name, or with that in
// its name.
Result<std::unique_ptr<FrameSource>> open_frame_source(const std::string& called,
                                                       const SourceOptions& options = {});

// One as above; several are pictures, and folders of them, in this order.
Result<std::unique_ptr<FrameSource>> open_frame_source(const std::vector<std::string>& called,
                                                       const SourceOptions& options = {});

// One line for people on what was opened: for a camera what was asked for and what was made of it.
std::string line_on(const FrameSource& source);

// The files of pictures that these names mean, in the order in which they are played:
// Frame::sequence counts them from 1.
Result<std::vector<std::string>> picture_files(const std::vector<std::string>& called);

}  // namespace dance
