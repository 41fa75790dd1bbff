// Converts a recording from one kind of file to another: the work of `dance convert`.
//
// Units/frames: seconds from the first pose to the last.
// Ownership:    plain values.
// Threads:      none inside; reads and writes files on the caller's thread.
// Failure:      an Error names the file and the cure, and leaves no file behind. What is damaged or
//               beyond a bound is left out and said, so that the user keeps the only good copy.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/bus/channel.h"
#include "formats/bvh/retarget.h"

namespace dance {

struct ConversionOptions {
  std::string from, to;
  GuestId guest;  // not set: all
  double hz = 0.0;
  std::optional<Where> where;
  RetargetOptions retarget;  // unit and axis of a BVH or glTF
};

struct Conversion {
  std::uint64_t frames = 0;
  std::uint64_t guests = 0;
  double seconds = 0.0;
  std::vector<std::string> notes;
  std::string lost;      // of the input, damaged
  std::string left_out;  // of the output, beyond a bound
};

// `to` must not be there yet. It is written as `to`.part, which becomes `to` when all is in it.
Result<Conversion> convert_recording(const ConversionOptions& options);

}  // namespace dance
