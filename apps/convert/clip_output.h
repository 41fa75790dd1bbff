// Clips as outputs of `dance convert`: a BVH of one guest, a GLB of all.
//
// Units/frames: frames at a steady rate (formats/recording/steady_clip.h).
// Ownership:    keeps the frames of at most kMostGuests guests until the end.
// Threads:      none inside.
// Failure:      as apps/convert/convert_sink.h; several guests for a BVH are named.
#pragma once

#include "apps/convert/convert_sink.h"

namespace dance {

std::unique_ptr<ConvertSink> make_bvh_output(const SinkOptions& options);
std::unique_ptr<ConvertSink> make_glb_output(const SinkOptions& options);

}  // namespace dance
