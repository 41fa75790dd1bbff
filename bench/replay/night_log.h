// A long recorded night, packed, for measurements of replay: salsa dancers at 60 Hz with their
// proportions, who leave the floor now and then, and music in songs of four minutes.
//
// Units/frames: the house's clock begins at 500 s.
// Ownership:    writes a file.
// Threads:      packs in as many threads as the machine has; they end with the call.
// Failure:      names the file that cannot be written.
#pragma once

#include <cstdint>
#include <string>

#include "formats/log/log_packer.h"

namespace dance {

struct NightWish {
  int guests = 30;
  double minutes = 60.0;
  // Every pose also as it came into the house, as the manager's own house records it.
  bool has_arriving = false;
  Duration intra_frame_period = LogPacker::kIntraFramePeriod;
};

Result<void> make_night_log(const std::string& path, const NightWish& wish);

}  // namespace dance
