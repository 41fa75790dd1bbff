// Sends takes over a lossy line in simulated time, under one policy of references, with
// acknowledgements and requests for intra frames on the way back, as the tunnel has them.
//
// Units/frames: poses are one period of the take apart; losses are the same for each policy.
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
