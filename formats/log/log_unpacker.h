// LogUnpacker: restores the events of a packed log, byte for byte; plain events pass through. Input
// is untrusted: a result counts only if its checksum matches.
//
// Units/frames: events as in formats/log/log_file.h.
// Ownership:    unpack() returns a view of its argument or of the unpacker; valid until its next
//               call. 70 KB for each channel of packed poses, 140 KB of hands, at most
//               kMaxMotionStreams of them.
// Threads:      none inside; one owner. Well under 0.1 ms a message.
// Failure:      an event that cannot be restored is nullopt and counted by cause; its channel
//               resumes with its next intra frame, the others are not affected.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/base/byte_reader.h"
#include "formats/log/motion_stream.h"
#include "formats/log/packed_event.h"

namespace dance {

class LogUnpacker {
 public:
  struct Counters {
    std::uint64_t unpacked = 0;  // poses and hands
    std::uint64_t damaged = 0;   // malformed, or wrong checksum
    std::uint64_t orphaned = 0;  // refer to a damaged or missing one
    std::uint64_t newer = 0;     // of an unknown version
    std::uint64_t lost() const { return damaged + orphaned + newer; }
  };

  std::optional<LogEvent> unpack(const LogEvent& event);
  // Forgets all channels and counts: the next events are of another log, or of the same from its
  // beginning.
  void restart() {
    streams_.clear();
    counters_ = {};
  }
  const Counters& counters() const { return counters_; }

 private:
  struct Stream {
    explicit Stream(MotionType type) : unpacker(type) {}
    MotionUnpacker unpacker;
    std::uint64_t last_used = 0;
  };

  std::optional<LogEvent> unpack_motion(const LogEvent& event, MotionType type, bool is_key,
                                        ByteReader body);
  Stream* stream_of(std::string_view channel, MotionType type, bool is_key);

  std::map<std::string, std::unique_ptr<Stream>, std::less<>> streams_;
  std::uint64_t uses_ = 0;
  Counters counters_;
  RawMotion motion_;
  MessageBuffer message_;
};

}  // namespace dance
