// Between plain and packed LCM logs, in either direction: the work of `dance pack` and
// `dance unpack`. Reads both kinds, also one behind the other.
//
// Units/frames: sizes are those of the files.
// Ownership:    plain values.
// Threads:      none inside; reads and writes files on the caller's thread.
// Failure:      an Error names the file and the cure, and leaves no file behind. What is damaged is
//               left out and counted; then check_is_whole() is an Error, so that the user keeps the
//               only good copy.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/result.h"
#include "formats/log/log_packer.h"
#include "formats/log/log_unpacker.h"

namespace dance {

enum class LogForm { kPlain, kPacked };

struct LogConversion {
  std::string from, to;
  LogForm form = LogForm::kPlain;  // of what was written
  std::uint64_t events = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t skipped_bytes = 0;
  LogUnpacker::Counters unpacking;
  LogPacker::Counters packing;
};

// `to` must not be there yet. It is written as `to`.part, which becomes `to` when all is in it. A
// file without a single event that could be had is an Error.
Result<LogConversion> convert_log(const std::string& from, const std::string& to, LogForm form);

// One line: both sizes.
std::string conversion_line(const LogConversion& conversion);
Result<void> check_is_whole(const LogConversion& conversion);
// Of what was packed: says where its input held packed events, else "". These come back unpacked,
// so that unpacking does not give that very file.
std::string packed_before(const LogConversion& conversion);

}  // namespace dance
