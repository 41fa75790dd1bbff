#include "apps/demo/demo_rhythm.h"

#include <algorithm>
#include <cmath>

#include "core/pose/interpolate.h"
#include "core/pose/kinematics.h"
#include "testing/motion/beat_phase.h"

namespace dance {
namespace {

constexpr double kPicture_hz = 60.0;
constexpr Duration kWarmUp = Duration::s(3);  // of the stage, which adapts to line and music
constexpr Duration kLongest = Duration::s(60);
constexpr Duration kShortest = Duration::s(3);
constexpr double kBar_beats = 8.0;  // as dancers count

// Interpolated between two poses.
std::optional<Pose> pose_at(const std::vector<TracedPose>& list, MonoTime t) {
  const auto after = std::upper_bound(
      list.begin(), list.end(), t, [](MonoTime a, const TracedPose& pose) { return a < pose.at; });
  if (after == list.begin() || after == list.end()) return std::nullopt;
  const TracedPose &before = *(after - 1), &next = *after;
  return interpolate(
      before.pose, next.pose,
      static_cast<float>((t - before.at).as_seconds() / (next.at - before.at).as_seconds()));
}

std::optional<double> beats_at(const std::vector<TracedBeats>& music, MonoTime t) {
  if (music.empty()) return std::nullopt;
  const auto after =
      std::upper_bound(music.begin(), music.end(), t,
                       [](MonoTime a, const TracedBeats& beats) { return a < beats.at; });
  const TracedBeats& from = after == music.begin() ? music.front() : *(after - 1);
  return from.beats + (t - from.at).as_seconds() * from.beats_per_second;
}

struct Span {
  MonoTime from, to;
};

// The span in which all that is compared is present.
std::optional<Span> common_span(const DemoTrace& trace) {
  Span span{MonoTime::from_us(1), MonoTime::from_us(INT64_MAX / 2000)};
  for (const auto* list : {&trace.danced(), &trace.raw(), &trace.shown(), &trace.of_here()}) {
    if (list->empty()) return std::nullopt;
    span.from = std::max(span.from, list->front().at);
    span.to = std::min(span.to, list->back().at);
  }
  if (trace.music().empty()) return std::nullopt;
  span.from = std::max({span.from + kWarmUp, trace.music().front().at, span.to - kLongest});
  span.to = std::min(span.to, trace.music().back().at);
  if (span.to - span.from < kShortest) return std::nullopt;
  return span;
}

struct Pictures {
  std::vector<MonoTime> times;
  std::vector<Pose> poses;
  std::vector<double> beats;  // of the music in house A
};

Pictures pictures_of(const std::vector<TracedPose>& list, const DemoTrace& trace,
                     const Span& span) {
  Pictures pictures;
  const Duration period = Duration::period_of_hz(kPicture_hz);
  for (MonoTime t = span.from; t < span.to; t += period) {
    const auto pose = pose_at(list, t);
    const auto beats = beats_at(trace.music(), t);
    if (!pose || !beats) continue;
    pictures.times.push_back(t);
    pictures.poses.push_back(*pose);
    pictures.beats.push_back(*beats);
  }
  return pictures;
}

StageFigures figures_of(const std::vector<TracedPose>& list, const DemoTrace& trace,
                        const Span& span, const DanceOnBeats& danced, double beat_ms) {
  StageFigures figures;
  const Pictures pictures = pictures_of(list, trace, span);
  if (pictures.poses.empty()) return figures;
  std::vector<double> offsets;
  std::vector<Pose> at_that_moment;
  for (std::size_t i = 0; i < pictures.poses.size(); ++i) {
    const Pose& pose = pictures.poses[i];
    figures.content_delay_ms += (pictures.times[i] - pose.capture_time).as_ms() /
                                static_cast<double>(pictures.poses.size());
    // Whole beats behind are no error; as tagged with the dancer's own musical time.
    const double behind = pictures.beats[i] - pose.music_beats;
    offsets.push_back(std::isfinite(behind) ? std::round(behind) : 0.0);
    const auto truth = pose_at(trace.danced(), pictures.times[i]);
    at_that_moment.push_back(truth.value_or(pose));
  }
  const JointTrack track(trace.body_of_remote(), pictures.poses, kPicture_hz);
  const JointTrack truth(trace.body_of_remote(), at_that_moment, kPicture_hz);
  const BeatPhase phase =
      beat_phase({&track, pictures.beats}, danced, offsets, 0, pictures.poses.size());
  figures.phase_mean_ms = phase.mean_beats * beat_ms;
  figures.phase_sd_ms = phase.sd_beats * beat_ms;
  figures.error_mm = 1e3 * body_error_m(track, truth);
  const double jerk = jerk_m_s3(truth, Places::kWorld);
  if (jerk > 0.0) figures.jerk_ratio = jerk_m_s3(track, Places::kWorld) / jerk;
  return figures;
}

// When the music in house A was at this musical time of the dancer.
double beats_danced_at(const DemoTrace& trace, const Pose& pose) {
  return std::isfinite(pose.music_beats) ? pose.music_beats
                                         : beats_at(trace.music(), pose.capture_time).value_or(0.0);
}

double sway_cm(const Skeleton& body, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(body, pose, frames);
  Eigen::Vector3f left = frames.R_WB[index_of(Bone::kHips)] * Eigen::Vector3f::UnitX();
  left.y() = 0.0f;
  if (left.squaredNorm() < 1e-6f) return 0.0;
  const Eigen::Vector3f feet =
      0.5f * (frames.position(Bone::kLeftFoot) + frames.position(Bone::kRightFoot));
  return 100.0 * static_cast<double>((pose.p_WH_m - feet).dot(left.normalized()));
}

}  // namespace

std::optional<DemoRhythm> measure_rhythm(const DemoTrace& trace) {
  const auto span = common_span(trace);
  if (!span) return std::nullopt;
  std::vector<Pose> danced;
  DanceOnBeats truth;
  for (const TracedPose& traced : trace.danced()) {
    danced.push_back(traced.pose);
    truth.beats.push_back(beats_danced_at(trace, traced.pose));
  }
  const JointTrack track(trace.body_of_remote(), danced, kPicture_hz);
  truth.track = &track;
  DemoRhythm rhythm;
  const double beats_per_second = trace.music().back().beats_per_second;
  if (!(beats_per_second > 0.0)) return std::nullopt;
  rhythm.tempo_bpm = 60.0 * beats_per_second;
  rhythm.seconds = (span->to - span->from).as_seconds();
  rhythm.raw = figures_of(trace.raw(), trace, *span, truth, 1e3 / beats_per_second);
  rhythm.shown = figures_of(trace.shown(), trace, *span, truth, 1e3 / beats_per_second);
  return rhythm;
}

std::vector<double> beats_to_show(const DemoTrace& trace) {
  constexpr int kBeats = 6;
  const auto span = common_span(trace);
  if (!span) return {};
  const double last = std::floor(*beats_at(trace.music(), span->to)) - kBeats;
  const double first_there = std::ceil(*beats_at(trace.music(), span->from));
  double first = kBar_beats * std::floor(last / kBar_beats);
  if (first < first_there) first = last;
  if (first < first_there) return {};
  std::vector<double> beats;
  for (int i = 0; i < kBeats; ++i) beats.push_back(first + i);
  return beats;
}

std::optional<SwayLines> sway_lines(const DemoTrace& trace, double span_beats) {
  const auto span = common_span(trace);
  if (!span) return std::nullopt;
  const double last = *beats_at(trace.music(), span->to);
  const double begin = kBar_beats * std::floor((last - span_beats) / kBar_beats);
  SwayLines lines;
  lines.tempo_bpm = 60.0 * trace.music().back().beats_per_second;
  const auto add = [&](SwayLine& line, double beats, const Skeleton& body, const Pose& pose) {
    if (beats < begin || beats > begin + span_beats) return;
    line.beats.push_back(beats);
    line.sway_cm.push_back(sway_cm(body, pose));
  };
  for (const TracedPose& traced : trace.of_here())
    add(lines.here, beats_danced_at(trace, traced.pose), trace.body_of_here(), traced.pose);
  for (const TracedPose& traced : trace.danced())
    add(lines.danced, beats_danced_at(trace, traced.pose), trace.body_of_remote(), traced.pose);
  for (const auto& [list, line] :
       {std::pair{&trace.raw(), &lines.raw}, std::pair{&trace.shown(), &lines.shown}})
    for (const TracedPose& traced : *list)
      if (const auto beats = beats_at(trace.music(), traced.at))
        add(*line, *beats, trace.body_of_remote(), traced.pose);
  return lines;
}

}  // namespace dance
