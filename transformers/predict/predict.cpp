#include "transformers/predict/predict.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr std::size_t kPredictedPoses = 1024;  // 12 s at 60 Hz and somewhat more
// Beyond this the capture times are of another clock.
constexpr Duration kLongestTransit = Duration::s(2);
constexpr Duration kEarliest = Duration::ms(-100);
// A dance does not go back by less than this: then its time has jumped.
constexpr Duration kJumpBack = Duration::ms(500);
constexpr Duration kTempoSpan = Duration::s(1);
// A body that is measured again differs by less; this is another dancer's.
constexpr float kOtherBody_m = 0.03f;
constexpr double kMostBeatsPerSecond = kMostTempo_bpm / 60.0;

// How fast the dancer's music goes, by the poses of the last second; 0 where there is none.
double beats_per_second(const PoseHistory& history) {
  const Pose& newest = history.newest();
  if (std::isnan(newest.music_beats)) return 0.0;
  const auto before = history.at(newest.capture_time - kTempoSpan);
  if (!before || std::isnan(before->pose.music_beats)) return 0.0;
  const double s = (newest.capture_time - before->pose.capture_time).as_seconds();
  if (s < 0.1) return 0.0;
  return std::clamp((newest.music_beats - before->pose.music_beats) / s, 0.0, kMostBeatsPerSecond);
}

}  // namespace

Predict::Predict(const PredictOptions& options)
    : options_(options),
      predictor_(options.model ? options.model : built_in_predict_model()),
      history_(kPredictedPoses) {}

void Predict::set_body(const Skeleton& skeleton) {
  if (!is_valid(skeleton)) return;
  const BoneLengths lengths = bone_lengths(skeleton);
  if (body_ && !is_alike(*body_, lengths, kOtherBody_m)) predictor_.forget_dancer();
  body_ = lengths;
  const auto& model = options_.model ? options_.model : built_in_predict_model();
  predictor_.set_acquaintance(model->knows(skeleton) ? Acquaintance::kDancer
                                                     : Acquaintance::kOthers);
  finish_.set_body(skeleton);
}

void Predict::forget() {
  ++counters_.restarts;
  history_.clear();
  least_transit_.forget();
  has_shown_ = false;
  finish_.clear();
}

void Predict::observe(const Pose& pose, MonoTime now) {
  Pose was;
  const bool corrects = has_shown_ && pose_at(shown_, options_.most, was);
  const bool had = !predictor_.is_empty();
  const MonoTime before = had ? predictor_.newest().capture_time : MonoTime();
  const bool same_clock = had && predictor_.newest().clock_id == pose.clock_id;
  // A gap is filled with rows, each of which costs as much as a pose: who makes gaps all the time
  // begins anew instead.
  if (!rows_allowed_.take(predictor_.rows_until(pose.capture_time), now)) predictor_.lose_thread();
  switch (predictor_.observe(pose)) {
    case SteadyRows::Heard::kRefused:
      ++counters_.refused;
      return;
    case SteadyRows::Heard::kRestarted:
      // After a gap the dance goes on; it is another when its time or its clock jumped.
      if (had && (!same_clock || pose.capture_time < before)) forget();
      break;
    case SteadyRows::Heard::kTaken:
      break;
  }
  if (history_.push(pose)) finish_.observe(pose, now);
  note_transit(now - pose.capture_time, now);
  Pose is;
  if (corrects && has_shown_ && pose_at(shown_, options_.most, is))
    finish_.correct(shown_at_, was, is);
}

void Predict::note_transit(Duration transit, MonoTime now) {
  if (least_transit_.add(transit, now)) transit_ = transit;
  // A large change is another line or clock.
  const Duration least = least_transit_.value(), error = least - transit_;
  transit_ = error > kJumpBack || error < -kJumpBack ? least : transit_ + error / 64;
}

MonoTime Predict::moment(MonoTime now) {
  if (input_) return input_->moment(now);
  if (history_.empty()) return now;
  if (transit_ > kLongestTransit || transit_ < kEarliest) return now - transit_;
  return now - Duration::seconds(transit_.as_seconds() * (1.0 - options_.lead));
}

bool Predict::pose_at(MonoTime moment, Duration most, Pose& out) const {
  if (history_.empty()) return false;
  const Pose& newest = history_.newest();
  if (moment <= newest.capture_time) {
    out = history_.at(moment)->pose;
    return true;
  }
  const MonoTime last = newest.capture_time + most;
  predictor_.predict(std::min(moment, last), out);
  out.capture_time = moment;
  out.music_beats += beats_per_second(history_) * (moment - newest.capture_time).as_seconds();
  for (MonoTime& hop : out.hops)
    if (hop.is_set()) hop += moment - newest.capture_time;
  return true;
}

bool Predict::sample_at(MonoTime moment, MonoTime /*now*/, Pose& out) {
  return pose_at(moment, DancePredictor::kFurthest, out);
}

bool Predict::sample(MonoTime now, Pose& out) {
  if (history_.empty()) return false;
  MonoTime wanted = moment(now);
  // The delay that is not taken back may change: the dance stands still rather than go back.
  if (has_shown_ && wanted < shown_ && wanted > shown_ - kJumpBack) wanted = shown_;
  if (wanted > history_.newest().capture_time + options_.most) ++counters_.starved;
  if (!pose_at(wanted, options_.most, out)) return false;
  finish_.apply(now, out, wanted > history_.newest().capture_time);
  shown_ = wanted;
  shown_at_ = now;
  has_shown_ = true;
  return true;
}

}  // namespace dance
