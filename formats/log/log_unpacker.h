// LogUnpacker: the events of a packed log as they were before LogPacker, byte for byte; what is not
// packed goes through. Reads what strangers wrote: nothing in an event is believed that its
// checksum does not confirm.
//
// Units/frames: events as in formats/log/log_file.h.
// Ownership:    what unpack() gives looks at the event that it was given, or at the unpacker; valid
//               until its next call. 70 KB for each channel of packed poses, 140 KB of hands, at
//               most kMaxMotionStreams of them.
// Threads:      none inside; one owner. Well under 0.1 ms a message.
// Failure:      an event that cannot be had is nullopt and counted by cause; its channel goes on
//               with its next key frame, the others as if nothing had been.
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
    std::uint64_t damaged = 0;   // malformed, or not what was packed
    std::uint64_t orphaned = 0;  // go on from one that was damaged or is not there
    std::uint64_t newer = 0;     // of a version that this program does not know
    std::uint64_t lost() const { return damaged + orphaned + newer; }
  };

  std::optional<LogEvent> unpack(const LogEvent& event);
  // Forgets all channels: the next events are of another log, or of the same from its beginning.
  void restart() { streams_.clear(); }
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
