#include "producers/replay/log_player.h"

#include <algorithm>

#include "core/bus/encode.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

// Events played in one turn of the poller: a log with thousands of events at one instant must not
// stall the loop.
constexpr int kEventsPerTurn = 1024;
// Channels with a time of their own; more are stamped with their deadline.
constexpr std::size_t kMaxAnchors = 256;
// A pose further from its deadline than this is of another clock (a looped or joined log): a new
// anchor.
constexpr Duration kMaxDrift = Duration::ms(500);
constexpr std::int64_t kMaxPause_us = 60'000'000;

// The moment that a message tells of.
template <class Message>
MonoTime& time_of(Message& message) {
  if constexpr (requires { message.capture_time; })
    return message.capture_time;
  else
    return message.time;
}

}  // namespace

LogPlayer::LogPlayer(UnpackedLog log, LogPlayerOptions options, SignalPort& bus, Poller& poller,
                     MonoTime start)
    : log_(std::move(log)), options_(std::move(options)), bus_(bus), start_(start) {
  is_over_ = !read_next();
  if (!is_over_) poller.add_timer(start, [this](MonoTime now) { return play(now); });
}

bool LogPlayer::is_wanted(const Channel& channel) const {
  switch (channel.signal()) {
    case Signal::kPose:
    case Signal::kHands:
    case Signal::kSkeleton:
    case Signal::kBeat:
    case Signal::kTouch:
    case Signal::kHaptic:
      break;
    case Signal::kVoice:
      if (options_.speed == 1.0) break;  // sound has one speed
      return false;
    default:
      return false;
  }
  const Where where = channel.signal() == Signal::kBeat ? Where::kCapture : channel.where();
  return options_.only.empty() ||
         std::find(options_.only.begin(), options_.only.end(), where) != options_.only.end();
}

bool LogPlayer::read_next() {
  while ((next_ = log_.next())) {
    const auto channel = Channel::parse(next_->channel);
    if (!channel || !is_wanted(*channel)) {
      ++counters_.left_out;
      continue;
    }
    if (!has_first_) {
      first_time_us_ = last_time_us_ = next_->time_us;
      has_first_ = true;
    }
    const std::int64_t step_us = next_->time_us - last_time_us_;
    if (step_us > kMaxPause_us || step_us < -kMaxPause_us) {
      first_time_us_ += step_us;  // a joined or damaged log: go on without the gap
      ++counters_.gaps;
    }
    last_time_us_ = next_->time_us;
    return true;
  }
  return false;
}

MonoTime LogPlayer::deadline_of(const LogEvent& event) const {
  const double since_first = static_cast<double>(event.time_us - first_time_us_) * 1e-6;
  return start_ + Duration::seconds(std::clamp(since_first, 0.0, 1e6) / options_.speed);
}

// Each round starts its counts at zero; the highest are those of a whole round.
void LogPlayer::note_damage() {
  skipped_bytes_ = std::max(skipped_bytes_, log_.skipped_bytes());
  if (log_.unpacking().lost() >= unpacking_.lost()) unpacking_ = log_.unpacking();
}

bool LogPlayer::start_again(MonoTime now) {
  if (!options_.loop || !played_this_round_ || !log_.ended()) return false;
  ++counters_.loops;
  note_damage();
  log_.rewind();
  played_this_round_ = false;
  has_first_ = false;
  start_ = now + Duration::ms(16);
  return read_next();
}

MonoTime LogPlayer::play(MonoTime now) {
  for (int i = 0; i < kEventsPerTurn; ++i) {
    const MonoTime deadline = deadline_of(*next_);
    if (deadline > now) return deadline;
    publish(*next_, deadline);
    played_this_round_ = true;
    if (!read_next() && !start_again(now)) {
      is_over_ = true;
      return {};
    }
  }
  return now;
}

MonoTime LogPlayer::restamp(const Channel& channel, MonoTime captured, MonoTime deadline) {
  for (Anchor& anchor : anchors_) {
    if (!(anchor.channel == channel)) continue;
    const Duration since = captured - anchor.then;
    const MonoTime stamped = anchor.now + Duration::seconds(since.as_seconds() / options_.speed);
    const Duration drift = stamped - deadline;
    if (drift < kMaxDrift && drift > -kMaxDrift) return stamped;
    anchor.then = captured;
    anchor.now = deadline;
    return deadline;
  }
  if (anchors_.size() < kMaxAnchors) anchors_.push_back({channel, captured, deadline});
  return deadline;
}

template <class Message>
void LogPlayer::publish_as(const Channel& channel, const LogEvent& event, MonoTime deadline) {
  Message message;
  if (decode(event.data.data(), event.data.size(), message) != Decoded::kFine) {
    ++counters_.undecodable;
    return;
  }
  MonoTime& time = time_of(message);
  const MonoTime recorded = time;
  time = restamp(channel, recorded, deadline);
  message.clock_id = this_clock_id();
  const auto moved = [&](MonoTime moment) {
    return time + Duration::seconds((moment - recorded).as_seconds() / options_.speed);
  };
  bool is_good = true;
  if constexpr (std::is_same_v<Message, Beat>) {
    // At a lower speed the next beat is later and the tempo lower.
    message.beat_time = moved(message.beat_time);
    message.tempo_bpm *= options_.speed;
    is_good = is_valid(message);
  } else if constexpr (std::is_same_v<Message, Haptic>) {
    // Its duration stays; the moment to play it at follows the speed.
    message.play_time = moved(message.play_time);
    message.maker = 0;  // as it was, whatever else would be made of the touches now
    is_good = is_valid(message);
  } else if constexpr (std::is_same_v<Message, Pose>) {
    message.hops = {};
    message.stamp(Hop::kPublished, mono_now());
  }
  if (!is_good) {
    ++counters_.left_out;
    return;
  }
  bus_.publish(channel, message);
  ++counters_.played;
}

void LogPlayer::publish(const LogEvent& event, MonoTime deadline) {
  const auto channel = Channel::parse(event.channel);
  switch (channel->signal()) {
    case Signal::kPose:
      return publish_as<Pose>(*channel, event, deadline);
    case Signal::kHands:
      return publish_as<Hands>(*channel, event, deadline);
    case Signal::kSkeleton:
      return publish_as<TimedSkeleton>(*channel, event, deadline);
    case Signal::kVoice:
      return publish_as<Voice>(*channel, event, deadline);
    case Signal::kBeat:
      return publish_as<Beat>(*channel, event, deadline);
    case Signal::kTouch:
      return publish_as<Touch>(*channel, event, deadline);
    case Signal::kHaptic:
      return publish_as<Haptic>(*channel, event, deadline);
    default:
      return;
  }
}

}  // namespace dance
