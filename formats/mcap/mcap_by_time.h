// Messages of an MCAP file in the order of their log times. Some writers put one channel behind the
// other; such a file is sorted through a temporary file, so that memory holds 48 bytes a message.
//
// Units/frames: as formats/mcap/mcap_reader.h.
// Ownership:    refers to the reader. The temporary file has no name and goes with the call.
// Failure:      read_by_time() of a file that cannot be read to its end, or that is out of order
//               and larger than the bounds below: an Error, without the file's name.
#pragma once

#include <functional>

#include "formats/mcap/mcap_reader.h"

namespace dance {

constexpr std::size_t kMostSorted_messages = std::size_t{1} << 23;
constexpr std::uint64_t kMostSorted_bytes = std::uint64_t{16} << 30;

// The place of a message among those of the same time; nullopt for one that is not needed.
using McapRank = std::optional<std::uint8_t> (*)(const McapMessage& message);

// Passes on all messages with a rank, from the start of the file; true if it was out of order.
Result<bool> read_by_time(McapReader& reader, McapRank rank,
                          const std::function<void(const McapMessage&)>& take);

}  // namespace dance
