// LogSink: writes a recording as a plain LCM log, as if it had been recorded on a bus: for
// lcm-logplayer, dance replay and dance view --log.
//
// Units/frames: an event's time is that of the recording; poses, hands and beats keep their clocks.
// Ownership:    owns the log file.
// Threads:      none inside; one owner.
// Failure:      finish() tells the first write that failed. Skeletons of guests beyond kMostGuests
//               are written once and not again.
#pragma once

#include <optional>

#include "core/base/fixed_list.h"
#include "core/bus/channel.h"
#include "core/bus/encode.h"
#include "formats/log/log_file.h"
#include "formats/recording/recording_sink.h"

namespace dance {

class LogSink : public RecordingSink {
 public:
  static constexpr std::size_t kMostGuests = 64;
  // A skeleton is published again so often, for those who begin to listen later.
  static constexpr std::int64_t kSkeletonAgain_us = 1'000'000;
  // The clock of what has none.
  static constexpr std::uint64_t kFileClockId = 1;

  LogSink(LogWriter writer, Where where) : writer_(std::move(writer)), where_(where) {}

  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t time_us) override;
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) override;
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t time_us) override;
  void on_beat(const Beat& beat, std::int64_t time_us) override;
  // What a guest looks like, as the guest's house says it.
  void on_avatar(const GuestId& guest, const Avatar& avatar, std::int64_t time_us);
  Result<void> finish();

  std::uint64_t events() const { return writer_.events(); }

 private:
  struct Guest {
    GuestId id;
    TimedSkeleton skeleton;
    std::int64_t written_us = 0;
  };
  template <class Message>
  void write(const Channel& channel, const Message& message, std::int64_t time_us);

  LogWriter writer_;
  Where where_;
  FixedList<Guest, kMostGuests> guests_;
  MessageBuffer buffer_;
  std::optional<Error> failure_;
};

}  // namespace dance
