// A dancer of a recording, for a house to play: of a BVH or glTF, an LCM log, plain or
// packed, an MCAP file or a table.
//
// Units/frames: clips of logs, MCAP files and tables have 60 frames a second.
// Ownership:    plain values.
// Threads:      none inside; reads the file on the caller's thread.
// Failure:      an Error names the file, who dances in it, and the cure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/guest_id.h"
#include "formats/clip/dancers_file.h"

namespace dance {

// Their names, in the order of the file; "" of a file that has one without a name.
Result<std::vector<std::string>> dancers_in_file(const std::string& path);
// The one that is asked for, else the one who is called as the guest, else the first.
std::string chosen_dancer(const std::string& asked, const GuestId& guest,
                          const std::vector<std::string>& names);
// `asked` as in the session file: "" = none in particular.
Result<NamedClip> load_dancer_of(const std::string& path, const std::string& asked,
                                 const GuestId& guest);

}  // namespace dance
