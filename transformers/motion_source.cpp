#include "transformers/motion_source.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr Duration kTempoSpan = Duration::s(1);
// Of a reach that is changed while dancing, in seconds.
constexpr double kReachPerSecond = 0.25;
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

MotionSource::MotionSource(DancerTimeline& timeline, Parts parts)
    : timeline_(timeline), parts_(std::move(parts)), reach_s_(parts_.reach.as_seconds()) {}

void MotionSource::set(Duration reach, bool conceals) {
  reach_s_.want(reach.as_seconds());
  may_conceal_ = conceals;
}

void MotionSource::observe() {
  has_from_ = false;
  if (parts_.extrapolator) {
    parts_.extrapolator->observe(timeline_.newest(), timeline_.arrived());
    if (parts_.partner)
      parts_.partner->observe(timeline_.newest(), timeline_.arrived(), *parts_.extrapolator);
  }
  // The dancer is back.
  if (parts_.concealment) parts_.concealment->end();
}

void MotionSource::restart() {
  if (parts_.partner) parts_.partner->restart();
  if (parts_.concealment) parts_.concealment->end();
}

void MotionSource::set_body() {
  has_from_ = false;
  if (parts_.extrapolator) parts_.extrapolator->set_body(timeline_.body());
  if (parts_.partner) parts_.partner->set_body(timeline_.body());
}

std::shared_ptr<Learner> MotionSource::learner() const {
  return parts_.extrapolator ? parts_.extrapolator->learner() : nullptr;
}

bool MotionSource::begin_continuation(MonoTime moment, MonoTime now, const PredictionLead& lead) {
  if (!reach_s_.is_settled())
    parts_.reach = Duration::seconds(reach_s_.advance(now, kReachPerSecond));
  else
    reach_s_.advance(now, 0.0);
  if (!may_conceal_ && !is_continuing()) return false;
  if (!parts_.concealment || parts_.concealment->is_running()) return false;
  if (!Concealment::is_lapse(timeline_, moment, now, predicts())) return false;
  if (!predicts()) {
    parts_.concealment->begin(timeline_, now);
    return true;
  }
  const Duration after = moment - timeline_.newest().capture_time;
  Pose meets;
  predict(moment, lead, true, meets);
  parts_.concealment->begin_with(timeline_, now, after, meets);
  return true;
}

void MotionSource::set_dancers(const PartnerTracks* dancers) {
  if (parts_.partner) parts_.partner->set_dancers(dancers);
}

void MotionSource::set_shown(MonoTime moment, MonoTime now) {
  if (parts_.partner) parts_.partner->set_shown(moment, now);
}

void MotionSource::predict(MonoTime moment, const PredictionLead& lead, bool is_guided, Pose& out) {
  const Pose& newest = timeline_.newest();
  const Duration ahead = moment - newest.capture_time;
  const Duration reached = std::min(ahead, parts_.reach);
  parts_.extrapolator->predict(newest.capture_time + reached, out);
  if (!lead.is_none()) {
    // Begun where the extrapolator saw the newest pose, which may be without an outlier of it.
    if (!has_from_) parts_.extrapolator->predict(newest.capture_time, from_);
    has_from_ = true;
    Pose half;
    parts_.extrapolator->predict(newest.capture_time + reached / 2, half);
    add_lead(from_, half, lead.at(reached), out);
  }
  if (is_guided && parts_.partner) parts_.partner->guide(newest.capture_time + reached, out);
  out.capture_time = moment;
  out.music_beats += beats_per_second(timeline_.poses()) * ahead.as_seconds();
  for (MonoTime& hop : out.hops)
    if (hop.is_set()) hop += ahead;
}

MotionSource::Kind MotionSource::at(MonoTime moment, Pose& out, const PredictionLead& lead) {
  return at(moment, lead, true, out);
}

MotionSource::Kind MotionSource::at_alone(MonoTime moment, Pose& out, const PredictionLead& lead) {
  return at(moment, lead, false, out);
}

MotionSource::Kind MotionSource::at(MonoTime moment, const PredictionLead& lead, bool is_guided,
                                    Pose& out) {
  const Pose& newest = timeline_.newest();
  if (moment <= newest.capture_time) {
    out = (parts_.is_final ? timeline_.at_for_good(moment) : timeline_.poses().at(moment))->pose;
    return Kind::kDanced;
  }
  if (predicts())
    predict(moment, lead, is_guided, out);
  else
    out = newest;
  if (is_continuing()) {
    parts_.concealment->mix_into(moment, out);
    return Kind::kContinued;
  }
  return predicts() ? Kind::kPredicted : Kind::kRepeated;
}

bool MotionSource::is_open(MonoTime moment, Kind kind) const {
  if (kind == Kind::kPredicted || kind == Kind::kContinued) return true;
  // Between the newest two poses the curve is not known before the next one, either.
  const PoseHistory& poses = timeline_.poses();
  return !parts_.is_final && poses.size() >= 2 && moment > poses.newest(1).capture_time;
}

}  // namespace dance
