// HostedHeadset: a dancer of a house with a headset: [[produce]] of kind "headset", and the words
// of `dance headset` for it.
//
// Units/frames: as `dance headset` takes them.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      read_headset() complains in the reader, with file, line and column.
#pragma once

#include <string>
#include <vector>

#include "core/base/guest_id.h"

namespace dance {

class TomlReader;  // its header costs a second in every file that reads it

struct HostedHeadset {
  GuestId guest;
  std::string at;    // "0,1.2,180"; "" = as dance headset has it
  std::string body;  // auto, rules or learned; "" = auto
  bool tracking_only = false;
  bool window = true;  // that shows the left eye
  bool haptics = true;
  bool tags = true;
  double personal_space_m = -1.0;  // less than 0: as dance headset has it, as for the next two
  double floor_m = -1.0;
  double scale = -1.0;
};

HostedHeadset read_headset(TomlReader& reader);

std::vector<std::string> headset_arguments(const HostedHeadset& headset, const std::string& bus);

}  // namespace dance
