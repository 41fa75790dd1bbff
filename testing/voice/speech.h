// Speech to test and measure voices with: made by espeak-ng, or read from a file.
//
// Units/frames: mono samples at 48 kHz, -1 to 1.
// Ownership:    plain values; a scratch file goes again.
// Threads:      none inside; waits for espeak-ng.
// Failure:      names the missing program or the file, and the cure.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

bool has_speech_maker();

// At least so long: sentences, again and again, with the pauses between them. Two speakers differ.
// `scratch` is a file to be used meanwhile.
Result<std::vector<float>> make_speech(double seconds, int speaker, const std::string& scratch);
Result<std::vector<float>> read_speech(const std::string& file);

}  // namespace dance
