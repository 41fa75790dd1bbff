#include "transformers/rhythm/rhythm_clock.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr Duration kProbeEvery = Duration::ms(33);
constexpr std::uint32_t kUntaggedPoses = 30;
constexpr float kLeastConfidence = 0.25f;
// Before predictions of this dancer have been measured: in the first half minute of one whom no
// model has seen they are some 50 to 60 mm off at this distance.
constexpr Duration kUnknownReach = Duration::ms(180);
// Where the delay is the least that predictions allow, they need not be that good all the time.
constexpr double kSlack_beats = 0.1;
// Nobody is asked for further ahead of what they dance now than this; musics that drift apart may
// add the slack.
constexpr double kMostAhead_beats = 0.05;
constexpr Duration kSpare = Duration::ms(60);
// Of a strength that is changed while dancing.
constexpr double kStrengthPerSecond = 0.5;
constexpr double kMostRhythmPaceChange = 0.1;
// Of the lead, where the dance comes to be in time, or is no longer.
constexpr double kRhythmLeadPerSecond = 1.0;
// The last fifth costs more error than it brings onto the beat.
constexpr double kMostLead = 0.8;
// What is further off is jumped to; without music there is no hurry, so more of it is walked.
constexpr Duration kJumpInTime = Duration::ms(300);
constexpr Duration kJumpFree = Duration::s(1);

// Mean distance of the joints in W between two moments; of one that has not come, as at the newest.
double joints_apart_m(const DancerTimeline& timeline, MonoTime a, MonoTime b) {
  const PoseHistory& poses = timeline.poses();
  BodyFrames at_a, at_b;
  forward_kinematics(timeline.body(), poses.at(a)->pose, at_a);
  forward_kinematics(timeline.body(), poses.at(b)->pose, at_b);
  double sum_m = 0.0;
  for (std::size_t bone = 0; bone < kBoneCount; ++bone)
    sum_m += static_cast<double>((at_a.p_WB_m[bone] - at_b.p_WB_m[bone]).norm());
  return sum_m / static_cast<double>(kBoneCount);
}

}  // namespace

RhythmClock::RhythmClock(const RhythmOptions& options, std::unique_ptr<PlayoutClock> free_running)
    : options_(options), strength_(options.strength), free_running_(std::move(free_running)) {}

void RhythmClock::set(const FlowSetting& setting) {
  if (free_running_) free_running_->set(setting);
  options_.beats = static_cast<double>(setting.rhythm_beats);
  options_.count = static_cast<double>(setting.rhythm_count);
  options_.most_error_m = 1e-3 * static_cast<double>(setting.rhythm_error_mm);
  strength_.want(setting.is_on(FlowWord::kRhythm) ? static_cast<double>(setting.rhythm_strength)
                                                  : 0.0);
}

void RhythmClock::restart() {
  if (free_running_) free_running_->restart();
  dance_.clear();
  play_out_.forget();
  offset_.reset();
  predictions_.clear();
  set_gains();
  own_beat_.forget();
  untagged_ = 0;
  probed_at_ = MonoTime();
  head_.reset();
}

void RhythmClock::observe(const DancerTimeline& timeline, MotionSource& source) {
  if (free_running_) free_running_->observe(timeline, source);
  play_out_.add(timeline.gap(), timeline.transit());
  take_tag(timeline);
  const double beats_per_second = in_time_ ? dance_.beats_per_second() : 0.0;
  const Duration beat =
      beats_per_second > 0.0 ? Duration::seconds(1.0 / beats_per_second) : Duration();
  if (predictions_.learn(timeline.poses(), beat)) set_gains();
  const MonoTime newest = timeline.newest().capture_time;
  if (probed_at_.is_set() && newest - probed_at_ < kProbeEvery) return;
  probed_at_ = newest;
  measure_predictions(timeline, source);
}

void RhythmClock::set_gains() {
  for (std::size_t h = 0; h < PredictionLead::kHorizons.size(); ++h)
    lead_.set_gain(h, predictions_.gain(h));
}

void RhythmClock::take_tag(const DancerTimeline& timeline) {
  const Pose& pose = timeline.newest();
  const MonoTime now = timeline.arrived();
  double beats = pose.music_beats;
  // The comparison is false for no tag, too.
  if (std::abs(beats) <= kMostBeats) {
    untagged_ = 0;
    has_own_beat_ = false;
  } else {
    // One pose without a tag is none; a dance without is one whose steps have to tell.
    if (++untagged_ < kUntaggedPoses || !timeline.music().is_known(now)) return;
    if (!has_own_beat_) own_beat_.forget();
    has_own_beat_ = true;
    Pose untagged = pose;
    untagged.music_beats = kNoMusic;
    const auto position =
        own_beat_.observe(untagged, now, 60.0 * timeline.music().beats_per_second());
    if (!position) {
      dance_.clear();
      return;
    }
    beats = *position;
  }
  if (dance_.add(pose.capture_time, beats)) offset_.reset();
}

void RhythmClock::measure_predictions(const DancerTimeline& timeline, MotionSource& source) {
  if (!free_running_) return;
  const MonoTime moment = timeline.newest().capture_time + predictions_.next_horizon();
  Pose prediction;
  source.at_alone(moment, prediction, PredictionMeter::measured_lead());
  predictions_.note(timeline.newest(), prediction, moment);
}

void RhythmClock::set_body(const Skeleton& skeleton) {
  predictions_.set_body(skeleton);
  own_beat_.set_body(skeleton);
}

MonoTime RhythmClock::free_moment(const DancerTimeline& timeline, MonoTime now) {
  return free_running_ ? free_running_->choose(timeline, now, MonoTime()).moment
                       : now - play_out_.needed();
}

void RhythmClock::choose_offset(const DancerTimeline& timeline, MonoTime now) {
  const BeatClock& music = timeline.music();
  const double beats_per_second = dance_.beats_per_second();
  // Who asks for a beat of delay asks for the truth: it grows as soon as what is shown would have
  // to be predicted. A stall then finds as much behind the newest pose as can be.
  Duration reach;
  if (options_.beats < 0.0)
    reach = predictions_.is_known() ? predictions_.reach(options_.most_error_m) : kUnknownReach;
  BeatOffset::Wish wish;
  wish.slack_beats = options_.beats < 0.0 ? kSlack_beats : 0.0;
  wish.beats = options_.beats;
  wish.count = options_.count;
  // Who asks for no delay at all gets predictions however far they have to reach.
  wish.least_beats = wish.easy_beats = -kMostAhead_beats;
  if (options_.beats != 0.0) {
    const Duration beyond = play_out_.needed() - reach;
    wish.least_beats = std::max(wish.least_beats, beyond.as_seconds() * beats_per_second);
    wish.easy_beats = std::max(wish.easy_beats, (beyond + kSpare).as_seconds() * beats_per_second);
  }
  const double heard = music.position(now);
  const MonoTime here = dance_.time_of(heard - offset_.value());
  offset_.update(wish, heard - dance_.position(now), now, [&](double value) {
    return joints_apart_m(timeline, here, dance_.time_of(heard - value));
  });
}

MonoTime RhythmClock::wanted_moment(const DancerTimeline& timeline, MonoTime now, double& pace) {
  const MonoTime free = free_moment(timeline, now);
  const BeatClock& music = timeline.music();
  pace = 1.0;
  in_time_ = (strength_.value() > 0.0 || strength_.wanted() > 0.0) && music.is_known(now) &&
             music.confidence() >= kLeastConfidence && dance_.is_known(now);
  if (!in_time_) {
    offset_.reset();
    return free;
  }
  choose_offset(timeline, now);
  const MonoTime on_beat = dance_.time_of(music.position(now) - offset_.value());
  // What has changed is walked to, at a pace that the play head follows.
  const double off_s = (on_beat - free).as_seconds();
  const double strength = strength_.advance(
      now, std::min(kStrengthPerSecond, kMostRhythmPaceChange / std::max(1e-3, std::abs(off_s))));
  pace = 1.0 + strength * (music.beats_per_second() / dance_.beats_per_second() - 1.0);
  return free + Duration::seconds(strength * off_s);
}

PlayoutClock::Choice RhythmClock::choose(const DancerTimeline& timeline, MonoTime now,
                                         MonoTime /*shown*/) {
  double pace = 1.0;
  const MonoTime wanted = wanted_moment(timeline, now, pace);
  // Where the truth was asked for, predictions fill a stall alone: a lead would scatter it.
  const bool leads = in_time_ && options_.beats <= 0.0;
  lead_strength_.want(leads ? kMostLead * strength_.value() : 0.0);
  lead_.set_strength(static_cast<float>(lead_strength_.advance(now, kRhythmLeadPerSecond)));
  const MonoTime moment = head_.advance(now, wanted, pace);
  const Duration off = wanted - moment;
  const Duration most = in_time_ ? kJumpInTime : kJumpFree;
  if (off <= most && off >= -most) return {moment, {}, false};
  head_.jump(wanted);
  return {wanted, moment, false};
}

void RhythmClock::explain(const DancerTimeline& timeline, MonoTime now, Playout& playout) const {
  if (strength_.wanted() <= 0.0) return;
  const BeatClock& music = timeline.music();
  if (!in_time_) {
    const bool has_music = music.is_known(now) && music.confidence() >= kLeastConfidence;
    playout.reason = has_music ? PlayoutReason::kBeatUnknown : PlayoutReason::kMusicMissing;
    return;
  }
  playout.beats =
      static_cast<float>(offset_.value() - (music.position(now) - dance_.position(now)));
  const Duration late = play_out_.needed();
  playout.limit_mm = static_cast<float>(1e3 * options_.most_error_m);
  if (predictions_.is_known())
    playout.error_mm = static_cast<float>(1e3 * predictions_.error_m(late));
  if (options_.beats >= 0.0)
    playout.reason = PlayoutReason::kAsked;
  else if (!predictions_.is_known())
    playout.reason = PlayoutReason::kNotMeasured;
  else
    playout.reason = predictions_.reach(options_.most_error_m) >= late ? PlayoutReason::kGoodEnough
                                                                       : PlayoutReason::kTooFar;
}

void RhythmClock::tag(MonoTime moment, Pose& pose) const {
  pose.capture_time = moment;
  pose.music_beats = dance_.is_known(moment) ? dance_.position(moment) : kNoMusic;
}

}  // namespace dance
