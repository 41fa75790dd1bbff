// UnpackedLog: a log file's events as they were on the bus, whether the log is packed, plain or
// mixed. For players and converters.
//
// Units/frames: event times are microseconds of the recorder's wall clock.
// Ownership:    owns the file; an event is valid until the next call.
// Threads:      none inside; one owner.
// Failure:      open() names the file and the reason; damage is skipped and counted. A read error
//               is not an end: ended() reports it.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"
#include "formats/log/log_file.h"
#include "formats/log/log_unpacker.h"

namespace dance {

class UnpackedLog {
 public:
  static Result<UnpackedLog> open(const std::string& path);
  // Reads bytes in memory, which must outlive it.
  static UnpackedLog over(std::span<const std::uint8_t> bytes);

  std::optional<LogEvent> next();
  // After the last event: success at the end of the file, else the read error.
  Result<void> ended() const { return reader_.ended(); }
  void rewind();

  // Bytes of the file outside complete events, and packed events that could not be restored.
  std::uint64_t skipped_bytes() const { return reader_.skipped_bytes(); }
  const LogUnpacker::Counters& unpacking() const { return unpacker_.counters(); }

 private:
  explicit UnpackedLog(LogReader reader) : reader_(std::move(reader)) {}

  LogReader reader_;
  LogUnpacker unpacker_;
};

}  // namespace dance
