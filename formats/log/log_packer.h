// LogPacker: converts the events of a bus to those of a packed log. A pose takes about a third of
// its bytes, hands a fifth; each is verified by unpacking, and kept unchanged where any bit
// differs. LogUnpacker is the inverse.
//
// Units/frames: times are those of the log, microseconds.
// Ownership:    pack() returns a view of its argument or of the packer; valid until its next call.
//               140 KB for each channel of poses, 280 KB of hands, at most kMaxMotionStreams of
//               them; allocates only for a channel's first message.
// Threads:      none inside; one owner. Well under 0.1 ms a message.
// Failure:      none: a message that cannot be packed exactly, or not in fewer bytes, is kept
//               unchanged and counted.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "formats/log/motion_stream.h"
#include "formats/log/packed_event.h"

namespace dance {

class LogPacker {
 public:
  // A damaged or lost event of a channel costs its messages up to the next intra frame.
  static constexpr Duration kIntraFramePeriod = Duration::ms(500);

  struct Counters {
    std::uint64_t packed = 0;        // poses and hands
    std::uint64_t intra_frames = 0;  // of them
    std::uint64_t kept = 0;          // poses and hands kept unchanged
    std::uint64_t plain_bytes = 0;   // size of the plain events, and
    std::uint64_t bytes = 0;         // of the packed ones: headers, channels and data
  };

  explicit LogPacker(Duration intra_frame_period = kIntraFramePeriod)
      : intra_frame_period_(intra_frame_period) {}

  // The event to store instead.
  LogEvent pack(const LogEvent& event);
  const Counters& counters() const { return counters_; }

 private:
  struct Stream {
    explicit Stream(MotionType type) : packer(type), unpacker(type) {}
    MotionPacker packer;
    MotionUnpacker unpacker;  // in the state of a reader of the log
    std::int64_t key_time_us = 0;
    std::uint64_t last_used = 0;
    std::string channel;  // with the prefix
  };

  LogEvent pack_motion(const LogEvent& event);
  LogEvent keep_as_it_was(const LogEvent& event);
  Stream& stream_of(std::string_view channel, MotionType type);
  bool comes_back(Stream& stream, bool is_key, std::span<const std::uint8_t> packed,
                  const LogEvent& event);

  Duration intra_frame_period_;
  std::map<std::string, std::unique_ptr<Stream>, std::less<>> streams_;
  std::uint64_t uses_ = 0;
  Counters counters_;
  RawMotion motion_;
  std::array<std::uint8_t, 16 + kMaxPackedMotion_bytes> packed_;
  std::vector<std::uint8_t> wrapped_;
};

}  // namespace dance
