#include "formats/recording/log_sink.h"

#include <algorithm>

namespace dance {

template <class Message>
void LogSink::write(const Channel& channel, const Message& message, std::int64_t time_us) {
  if (failure_) return;
  const std::size_t size = encode(message, buffer_);
  if (auto written = writer_.append(time_us, channel.view(), std::span(buffer_).first(size));
      !written)
    failure_ = written.error();
}

void LogSink::on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t time_us) {
  TimedSkeleton timed;
  timed.skeleton = skeleton;
  timed.clock_id = kFileClockId;
  const auto entry = std::find_if(guests_.begin(), guests_.end(),
                                  [&](const Guest& each) { return each.id == guest; });
  // The time and the clock of the newest pose of that guest, where one came before.
  if (entry != guests_.end()) {
    timed.clock_id = entry->skeleton.clock_id;
    timed.capture_time = entry->skeleton.capture_time;
    entry->skeleton = timed;
    entry->written_us = time_us;
    write(Channel::of(Signal::kSkeleton, where_, guest), timed, time_us);
  } else if (!guests_.try_push({guest, timed, time_us - kSkeletonAgain_us})) {
    write(Channel::of(Signal::kSkeleton, where_, guest), timed, time_us);
  }
}

void LogSink::on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) {
  Pose stamped = pose;
  if (stamped.clock_id == 0) stamped.clock_id = kFileClockId;
  // Players take the times of a log from these.
  const Hop last = where_ == Where::kStage ? Hop::kStaged : Hop::kPublished;
  if (!stamped.stamped(last).is_set()) stamped.stamp(last, stamped.capture_time);
  for (Guest& each : guests_) {
    if (!(each.id == guest)) continue;
    each.skeleton.clock_id = stamped.clock_id;
    each.skeleton.capture_time = stamped.capture_time;
    const std::int64_t since_us = time_us - each.written_us;
    if (since_us >= 0 && since_us < kSkeletonAgain_us) break;
    each.written_us = time_us;
    write(Channel::of(Signal::kSkeleton, where_, guest), each.skeleton, time_us);
    break;
  }
  write(Channel::of(Signal::kPose, where_, guest), stamped, time_us);
}

void LogSink::on_hands(const GuestId& guest, const Hands& hands, std::int64_t time_us) {
  Hands stamped = hands;
  if (stamped.clock_id == 0) stamped.clock_id = kFileClockId;
  write(Channel::of(Signal::kHands, where_, guest), stamped, time_us);
}

void LogSink::on_avatar(const GuestId& guest, const Avatar& avatar, std::int64_t time_us) {
  Avatar stamped = avatar;
  if (stamped.clock_id == 0) stamped.clock_id = kFileClockId;
  write(Channel::of(Signal::kAvatar, where_ == Where::kCapture ? where_ : Where::kGuest, guest),
        stamped, time_us);
}

void LogSink::on_beat(const Beat& beat, std::int64_t time_us) {
  write(Channel::of_house(Signal::kBeat), beat, time_us);
}

Result<void> LogSink::finish() {
  if (failure_) return tl::make_unexpected(*failure_);
  return writer_.flush();
}

}  // namespace dance
