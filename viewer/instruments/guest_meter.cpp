#include "viewer/instruments/guest_meter.h"

#include <algorithm>
#include <cmath>

#include "core/base/sequence.h"

namespace dance {
namespace {

constexpr Duration kSecond = Duration::s(1);
// A larger gap is not a loss: the sender restarted, or the guest was away.
constexpr std::int32_t kLargestGap = 600;
// One source is taken for what a display shows as long as it is heard of.
constexpr Duration kSourceHolds = Duration::s(1);
constexpr Duration kTrafficHolds = Duration::s(3);
// Poses of a log that is played onto a bus carry old stamps.
constexpr Duration kOldestLive = Duration::s(10);
constexpr double kJitterShare = 1.0 / 16.0;  // RFC 3550, 6.4.1

float ms(Duration duration) { return static_cast<float>(duration.as_ms()); }

}  // namespace

void GuestMeter::begin_at(MonoTime now) {
  if (begin_.is_set() && now >= begin_) return;
  const bool is_first = !begin_.is_set();
  begin_ = now;
  if (is_first) return;
  predictions_.restart();
  has_arrived_ = has_staged_ = has_shown_ = false;
  staged_count_ = 0;
  last_staged_ = last_shown_ = MonoTime();
  traffic_ = traffic_before_ = GuestTraffic();
}

bool GuestMeter::shows_stage(MonoTime now) const {
  if (has_shown_ && now - last_shown_ < kSourceHolds) return is_shown_staged_;
  return last_staged_.is_set() && now - last_staged_ < kSourceHolds;
}

void GuestMeter::count(std::uint32_t sequence) {
  ++received_;
  ++arrived_now_;
  const std::int32_t ahead = sequence_ahead(arrived_sequence_, sequence);
  if (!has_arrived_ || ahead > kLargestGap || ahead < -kLargestGap || ahead > 0) {
    if (has_arrived_ && ahead > 1 && ahead <= kLargestGap) {
      lost_ += ahead - 1;
      lost_now_ += ahead - 1;
    }
    arrived_sequence_ = sequence;
  } else if (ahead != 0) {  // a sender that does not count tells nothing about loss
    ++late_;
    if (lost_ > 0) --lost_;  // out of order, not lost
    if (lost_now_ > 0) --lost_now_;
  }
}

void GuestMeter::on_arrived(const Pose& pose, MonoTime heard, const BeatClock& music) {
  begin_at(heard);
  if (has_arrived_ && pose.sequence == arrived_sequence_ && pose.capture_time == newest_.capture &&
      newest_.sequence == pose.sequence)
    return;  // the network has doubled it
  count(pose.sequence);
  const bool is_live = pose.clock_id == clock_id_ && heard - pose.capture_time < kOldestLive;
  const MonoTime received = pose.stamped(Hop::kLinkReceived);
  const Duration transit = (received.is_set() && is_live ? received : heard) - pose.capture_time;
  if (has_arrived_) {
    const double apart_ms = std::abs((transit - transit_).as_ms());
    jitter_ms_ += kJitterShare * (std::min(apart_ms, 1000.0) - jitter_ms_);
  }
  transit_ = transit;
  predictions_.on_arrived(pose);
  if (!has_arrived_ || pose.capture_time > newest_.capture ||
      newest_.capture - pose.capture_time > kSecond)
    newest_ = {pose.sequence, pose.capture_time, pose.hops};
  has_arrived_ = true;
  if (shows_stage(heard)) return;
  if (is_live) add_gaps(pose.capture_time, pose.hops, heard);
  hear_beat(pose, heard, music);
}

void GuestMeter::on_staged(const Pose& pose, MonoTime heard, const BeatClock& music) {
  begin_at(heard);
  ++staged_now_;
  last_staged_ = heard;
  Arrival behind{pose.sequence, pose.capture_time, pose.hops};
  if (has_arrived_ && !is_pass_through_) {
    behind.capture = newest_.capture;
    for (std::size_t hop = 0; hop <= static_cast<std::size_t>(Hop::kLinkReceived); ++hop)
      behind.hops[hop] = newest_.hops[hop];
    horizon_ms_.add(ms(pose.capture_time - newest_.capture));
    predictions_.on_staged(pose);
  }
  staged_[staged_count_++ % kStagedKept] = behind;
  has_staged_ = true;
  if (!shows_stage(heard)) return;
  if (pose.clock_id == clock_id_ && heard - behind.capture < kOldestLive)
    add_gaps(behind.capture, behind.hops, heard);
  hear_beat(pose, heard, music);
}

void GuestMeter::add_gaps(MonoTime capture, const std::array<MonoTime, kHopCount>& hops,
                          MonoTime heard) {
  MonoTime last = capture;
  for (std::size_t hop = 0; hop < kHopCount; ++hop) {
    if (!hops[hop].is_set()) continue;
    gaps_ms_[hop].add(ms(hops[hop] - last));
    last = hops[hop];
  }
  gaps_ms_[kHeardGap].add(ms(heard - last));
}

void GuestMeter::hear_beat(const Pose& pose, MonoTime heard, const BeatClock& music) {
  if (!std::isfinite(pose.music_beats) || !music.is_known(heard)) return;
  beats_per_second_ = music.beats_per_second();
  beats_.add(pose.music_beats, music.position(heard), beats_per_second_, std::nullopt);
  has_beats_ = true;
}

void GuestMeter::on_shown(const StageTime& shown) {
  if (shown.clock_id != clock_id_ || shown.swap_time - shown.heard_time > kOldestLive) return;
  begin_at(shown.swap_time);
  const bool is_staged = shown.hops[static_cast<std::size_t>(Hop::kStaged)].is_set();
  const std::int32_t ahead = sequence_ahead(shown_sequence_, shown.sequence);
  if (has_shown_ && is_staged == is_shown_staged_ && ahead > 1 && ahead <= kLargestGap)
    superseded_ += ahead - 1;
  shown_sequence_ = shown.sequence;
  has_shown_ = true;
  is_shown_staged_ = is_staged;
  last_shown_ = shown.swap_time;
  ++shown_now_;
  gaps_ms_[kShownGap].add(ms(shown.swap_time - shown.heard_time));
  if (shown.swap_time - shown.capture_time > kOldestLive) return;
  age_ms_.add(ms(shown.swap_time - shown.capture_time));
  MonoTime arrived = shown.capture_time;
  for (std::size_t back = 1; is_staged && back <= std::min(staged_count_, kStagedKept); ++back) {
    const Arrival& staged = staged_[(staged_count_ - back) % kStagedKept];
    if (staged.sequence != shown.sequence) continue;
    arrived = staged.capture;
    break;
  }
  newest_ms_.add(ms(shown.swap_time - arrived));
}

void GuestMeter::on_flow(const FlowSetting& setting) {
  is_pass_through_ = std::none_of(setting.has.begin(), setting.has.end(), [](bool b) { return b; });
}

void GuestMeter::on_traffic(const GuestTraffic& traffic) {
  // A link that began anew counts from 0.
  const bool goes_on = traffic_.time.is_set() && traffic.bytes >= traffic_.bytes &&
                       traffic.received >= traffic_.received && traffic.time > traffic_.time;
  traffic_before_ = goes_on ? traffic_ : GuestTraffic();
  traffic_ = traffic;
}

void GuestMeter::tell_traffic(GuestStats& stats, MonoTime now) const {
  if (!traffic_before_.time.is_set() || now - traffic_.time > kTrafficHolds) return;
  const auto bytes = static_cast<double>(traffic_.bytes - traffic_before_.bytes);
  const auto poses = static_cast<double>(traffic_.received - traffic_before_.received);
  stats.bytes_per_second =
      static_cast<float>(bytes / (traffic_.time - traffic_before_.time).as_seconds());
  if (poses > 0.0) stats.bytes_per_pose = static_cast<float>(bytes / poses);
}

bool GuestMeter::is_due(MonoTime now) const {
  return begin_.is_set() && (now - begin_ >= kSecond || now < begin_);
}

GuestStats GuestMeter::end_second(MonoTime now) {
  GuestStats stats;
  const double seconds = std::max((now - begin_).as_seconds(), 1e-3);
  const auto rate = [&](std::int64_t n) {
    return static_cast<float>(static_cast<double>(n) / seconds);
  };
  stats.time = now;
  stats.clock_id = clock_id_;
  for (std::size_t gap = 0; gap < kGapCount; ++gap) {
    stats.gap_p50_ms[gap] = gaps_ms_[gap].percentile(0.5);
    stats.gap_p99_ms[gap] = gaps_ms_[gap].percentile(0.99);
    gaps_ms_[gap].clear();
  }
  const auto tell = [](Samples& samples, float& p50, float& p99) {
    p50 = samples.percentile(0.5);
    p99 = samples.percentile(0.99);
    samples.clear();
  };
  tell(newest_ms_, stats.newest_p50_ms, stats.newest_p99_ms);
  tell(age_ms_, stats.age_p50_ms, stats.age_p99_ms);
  tell(horizon_ms_, stats.horizon_p50_ms, stats.horizon_p99_ms);
  stats.arrival_hz = rate(arrived_now_);
  stats.stage_hz = rate(staged_now_);
  stats.shown_hz = rate(shown_now_);
  if (received_ > 1 && arrived_now_ > 0) {
    stats.jitter_ms = static_cast<float>(jitter_ms_);
    stats.loss_percent = static_cast<float>(100.0 * static_cast<double>(lost_now_) /
                                            static_cast<double>(lost_now_ + arrived_now_));
  }
  const PredictionCheck::Errors errors = predictions_.take();
  stats.error_mean_mm = errors.mean_mm;
  stats.error_p95_mm = errors.p95_mm;
  stats.hips_error_mm = errors.hips_mm;
  if (const auto beat = has_beats_ ? beats_.figures() : std::nullopt) {
    stats.beat_ms = beat->behind_ms;
    stats.beat_share =
        static_cast<float>(1e-3 * static_cast<double>(beat->behind_ms) * beats_per_second_);
  }
  tell_traffic(stats, now);
  stats.received = received_;
  stats.lost = lost_;
  stats.late = late_;
  stats.superseded = superseded_;
  has_beats_ = false;
  arrived_now_ = lost_now_ = staged_now_ = shown_now_ = 0;
  begin_ = now;
  return stats;
}

}  // namespace dance
