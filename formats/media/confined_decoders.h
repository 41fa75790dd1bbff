// Decoders of music and video that work on a confined thread (core/program/confinement.h), as such
// files come from strangers and their decoders are large.
//
// Ownership: the decoder that is returned owns its thread and the decoder that `open` made there.
// Threads:   one owner; each call waits for the confined thread.
// Failure:   errors of `open`; a thread that cannot be started is an Error too.
#pragma once

#include <functional>
#include <memory>

#include "formats/media/audio_decoder.h"
#include "formats/media/video_decoder.h"

namespace dance {

// `open` runs on the confined thread: libraries that it needs are loaded before.
Result<std::unique_ptr<AudioDecoder>> open_confined(
    std::function<Result<std::unique_ptr<AudioDecoder>>()> open);
Result<std::unique_ptr<VideoDecoder>> open_confined(
    std::function<Result<std::unique_ptr<VideoDecoder>>()> open);

}  // namespace dance
