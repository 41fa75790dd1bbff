// Sends takes over an emulated line that loses, under one policy of references, with
// acknowledgements and requests for key frames on the way back, as the tunnel has them.
//
// Units/frames: frames are one period of the take apart.
// Ownership:    none.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "core/codec/pose_codec.h"
#include "research/codec/codec_eval.h"

namespace dance {

LossResult send_over_line(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                          References policy);

}  // namespace dance
