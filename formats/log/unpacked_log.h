// UnpackedLog: a log file's events as they were on the bus, whether the log is packed, plain, or
// one behind the other. What players and converters read.
//
// Units/frames: event times are microseconds of the recorder's wall clock.
// Ownership:    owns the file; an event is valid until the next call.
// Threads:      none inside; one owner.
// Failure:      open() names the file and the reason; damage is skipped and counted. A file that
//               could not be read on is no end: ended() says so.
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
  // After the last event: fine at the end of the file, else what kept the rest from being read.
  Result<void> ended() const { return reader_.ended(); }
  void rewind();

  // Bytes of the file that belonged to no whole event, and packed events that could not be had.
  std::uint64_t skipped_bytes() const { return reader_.skipped_bytes(); }
  const LogUnpacker::Counters& unpacking() const { return unpacker_.counters(); }

 private:
  explicit UnpackedLog(LogReader reader) : reader_(std::move(reader)) {}

  LogReader reader_;
  LogUnpacker unpacker_;
};

}  // namespace dance
