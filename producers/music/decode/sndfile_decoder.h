// Decodes a file of music with libsndfile: WAV, FLAC, Ogg Vorbis, Opus, MP3 and others.
//
// Units/frames: as AudioDecoder.
// Ownership:    as AudioDecoder.
// Threads:      none inside; one owner.
// Failure:      libsndfile's own reason; AudioFile names file and cure. A file of unknown length is
//               decoded once to count its frames; one without seeking is read from its beginning.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "formats/media/audio_decoder.h"

namespace dance {

Result<std::unique_ptr<AudioDecoder>> open_with_sndfile(const std::string& path);

}  // namespace dance
