#include "viewer/feed/log_feed.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bus/encode.h"

namespace dance {
namespace {

constexpr std::size_t kMostWholeBeats = 1'000'000;
constexpr Duration kSeam = Duration::ms(16);  // from the last pose to the first, played again

bool is_pose(const Channel& channel, Where where) {
  return channel.signal() == Signal::kPose && channel.where() == where;
}

}  // namespace

Result<LogFeed> LogFeed::open(const std::string& path, bool stage_only) {
  DANCE_TRY(UnpackedLog log, UnpackedLog::open(path));
  LogFeed feed(path, std::move(log));
  if (auto looked = feed.look_through(); !looked) return tl::make_unexpected(looked.error());
  feed.board_ = std::make_unique<GuestBoard>(feed.clock_id_, stage_only);
  feed.instruments_ = std::make_unique<InstrumentBoard>(feed.clock_id_);
  feed.log_.rewind();
  feed.next_ = feed.log_.next();
  return feed;
}

// The house's clock, and the offset of the log's stamps from it: from the stage, or where it is
// empty, from captures.
Result<bool> LogFeed::find_times(Where where, Hop last) {
  std::int64_t least_ahead_us = std::numeric_limits<std::int64_t>::max();
  std::int64_t first_us = 0, last_us = 0;
  while (const auto event = log_.next()) {
    const auto channel = Channel::parse(event->channel);
    Pose pose;
    if (!channel || !is_pose(*channel, where) ||
        decode(event->data.data(), event->data.size(), pose) != Decoded::kFine ||
        !pose.stamped(last).is_set())
      continue;
    if (clock_id_ == 0) {
      clock_id_ = pose.clock_id;
      first_us = event->time_us;
    }
    last_us = event->time_us;
    least_ahead_us = std::min(least_ahead_us, event->time_us - pose.stamped(last).since_zero_us());
  }
  // A log that cannot be read on may have its poses behind that.
  if (auto ended = log_.ended(); !ended) return tl::make_unexpected(ended.error());
  log_.rewind();
  if (clock_id_ == 0) return false;
  wall_ahead_us_ = least_ahead_us;
  begin_ = MonoTime::from_us(first_us - wall_ahead_us_);
  end_ = MonoTime::from_us(last_us - wall_ahead_us_);
  return true;
}

// Its times, and where the beats are.
Result<void> LogFeed::look_through() {
  DANCE_TRY(bool is_found, find_times(Where::kStage, Hop::kStaged));
  if (!is_found) {
    DANCE_TRY(is_found, find_times(Where::kCapture, Hop::kPublished));
  }
  if (!is_found)
    return fail(path_ +
                ": nobody dances in this log; record a house with a manager, or a camera with "
                "dance capture --record");
  MusicHere music(clock_id_);
  double before = 0.0;
  bool was_known = false;
  while (const auto event = log_.next()) {
    const auto channel = Channel::parse(event->channel);
    if (!channel) continue;
    Pose pose;
    Beat beat;
    if (is_pose(*channel, Where::kCapture)) {
      if (decode(event->data.data(), event->data.size(), pose) == Decoded::kFine) music.see(pose);
    } else if (channel->signal() == Signal::kBeat) {
      if (decode(event->data.data(), event->data.size(), beat) == Decoded::kFine) music.hear(beat);
    } else {
      continue;
    }
    const MonoTime now = time_of(*event);
    if (!music.clock().is_known(now)) continue;
    const double beats = music.clock().position(now);
    if (was_known && beats > before && beats - before < 2.0 && beats_.size() < kMostWholeBeats &&
        std::floor(beats) > std::floor(before))
      beats_.push_back({std::floor(beats), music.clock().time_of(std::floor(beats))});
    before = beats;
    was_known = true;
  }
  return log_.ended();
}

MonoTime LogFeed::time_of(const LogEvent& event) const {
  return MonoTime::from_us(event.time_us - wall_ahead_us_) + shift_;
}

std::optional<MonoTime> LogFeed::time_of_beat(double beat) const {
  for (std::size_t i = 0; i < beats_.size(); ++i) {
    if (beats_[i].beat == beat) return beats_[i].time;
    if (i == 0 || beats_[i - 1].beat >= beat || beats_[i].beat <= beat) continue;
    const double share = (beat - beats_[i - 1].beat) / (beats_[i].beat - beats_[i - 1].beat);
    return beats_[i - 1].time +
           Duration::seconds(share * (beats_[i].time - beats_[i - 1].time).as_seconds());
  }
  return std::nullopt;
}

void LogFeed::go_on_to(MonoTime now) {
  for (; next_; next_ = log_.next()) {
    const MonoTime time = time_of(*next_);
    if (time > now) return;
    take(*next_, time);
  }
}

void LogFeed::begin_again() {
  shift_ += end_ - begin_ + kSeam;
  log_.rewind();
  next_ = log_.next();
}

void LogFeed::take(const LogEvent& event, MonoTime now) {
  const auto channel = Channel::parse(event.channel);
  if (!channel) return;
  // As it was recorded: its stamps are not shifted.
  instruments_->on_message(*channel, event.data.data(), event.data.size(), now - shift_);
  const auto read = [&](auto& message) {
    return decode(event.data.data(), event.data.size(), message) == Decoded::kFine;
  };
  const Where where = channel->where();
  if (channel->signal() == Signal::kBeat) {
    Beat beat;
    if (!read(beat)) return;
    beat.time += shift_;
    beat.beat_time += shift_;
    board_->on_beat(beat);
    return;
  }
  if (channel->signal() == Signal::kAvatar) {
    if (Avatar avatar; read(avatar)) board_->on_avatar(channel->guest(), avatar, now);
    return;
  }
  if (channel->signal() == Signal::kAvatarFile) {
    if (AvatarFile file; read(file)) board_->on_avatar(channel->guest(), file, now);
    return;
  }
  if (where != Where::kCapture && where != Where::kGuest && where != Where::kStage) return;
  if (channel->signal() == Signal::kPose) {
    Pose pose;
    if (!read(pose)) return;
    pose.capture_time += shift_;
    board_->on_pose(where, channel->guest(), pose, now);
  } else if (channel->signal() == Signal::kHands) {
    if (Hands hands; read(hands)) board_->on_hands(where, channel->guest(), hands, now);
  } else if (channel->signal() == Signal::kSkeleton) {
    if (TimedSkeleton timed; read(timed))
      board_->on_skeleton(channel->guest(), timed.skeleton, now);
  } else if (channel->signal() == Signal::kGuest) {
    if (GuestStatus status; read(status)) board_->on_status(channel->guest(), status, now);
  }
}

}  // namespace dance
