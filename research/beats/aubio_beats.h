// The beats that aubio hears in a file, to compare with: the program aubiotrack, run as it comes
// where it is installed. It is causal too.
//
// Units/frames: seconds from the begin of the file.
// Ownership:    plain values.
// Threads:      one; waits for the program.
// Failure:      an Error says that it is not installed and which package brings it, or that it
//               failed.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

Result<std::vector<double>> aubio_beats(const std::string& audio_path);

}  // namespace dance
