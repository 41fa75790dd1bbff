#include "research/lapse/predict_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "testing/line/line_arrivals.h"
#include "testing/motion/motion_measures.h"

namespace dance {
namespace {

// What is shown at the moment of each pose's capture, from the warm-up on, and what was danced
// then.
struct Streamed {
  std::vector<Pose> danced, shown;
};

Streamed stream_take(const CodecTake& take, StageSubject& subject, const StreamOptions& options) {
  Streamed streamed;
  LossySpec spec;
  spec.delay = options.delay;
  spec.tail = options.jitter;
  spec.loss = 0.01 * options.loss_percent;
  spec.seed = 0;
  LossyModel line({.spec = spec}, options.seed);
  const std::vector<LineArrival> arrivals = arrivals_over(
      line, take.poses.size(), [&](std::size_t i) { return take.poses[i].capture_time; },
      options.every);
  std::size_t next = 0;
  const MonoTime begin = take.poses.front().capture_time + options.warm_up;
  for (const Pose& danced : take.poses) {
    const MonoTime now = danced.capture_time;
    for (; next < arrivals.size() && arrivals[next].at <= now; ++next)
      subject.observe(take.poses[arrivals[next].index], arrivals[next].at);
    Pose shown;
    if (!subject.sample(now, shown) || now < begin) continue;
    streamed.danced.push_back(danced);
    streamed.shown.push_back(shown);
  }
  return streamed;
}

void add_take(const CodecTake& take, const Streamed& streamed, StreamFigures& sum) {
  const JointTrack danced(take.skeleton, streamed.danced, take.hz);
  const JointTrack shown(take.skeleton, streamed.shown, take.hz);
  const double seconds = static_cast<double>(danced.size()) / take.hz;
  const double lag_s = effective_lag_s(shown, danced);
  const Stance stance = stance_of(danced);
  const int late = static_cast<int>(std::lround(lag_s * take.hz));
  const PlayRate rate = play_rate(streamed.shown, take.hz);
  sum.error_m += seconds * body_error_m(shown, danced);
  sum.world_error_m += seconds * world_error_m(shown, danced, 0, danced.size());
  sum.lag_s += seconds * lag_s;
  sum.jerk += seconds * jerk_m_s3(shown, Places::kWorld) / jerk_m_s3(danced, Places::kWorld);
  sum.slide += seconds * slide_m_s(shown, stance, late) / slide_m_s(danced, stance);
  sum.play_least = sum.seconds > 0.0 ? std::min(sum.play_least, rate.least) : rate.least;
  sum.play_most = std::max(sum.play_most, rate.most);
  sum.seconds += seconds;
}

}  // namespace

StreamFigures evaluate_stream(const std::vector<CodecTake>& takes, const MakeSubject& make,
                              const StreamOptions& options) {
  StreamFigures sum;
  for (const CodecTake& take : takes) {
    const auto subject = make(take.skeleton);
    const Streamed streamed = stream_take(take, *subject, options);
    if (static_cast<double>(streamed.shown.size()) >= 2.0 * take.hz) add_take(take, streamed, sum);
  }
  if (sum.seconds <= 0.0) return sum;
  for (double* mean : {&sum.error_m, &sum.world_error_m, &sum.lag_s, &sum.jerk, &sum.slide})
    *mean /= sum.seconds;
  return sum;
}

std::string stream_table(const std::vector<StreamRow>& rows) {
  std::string text = fmt::format("{:<34}{:>9}{:>9}{:>8}{:>9}{:>8}{:>8}{:>16}\n", "", "error mm",
                                 "world mm", "lag ms", "of raw", "jerk", "feet", "play rate");
  const double raw_s = rows.empty() ? 0.0 : rows.front().figures.lag_s;
  for (const StreamRow& row : rows) {
    const StreamFigures& f = row.figures;
    text += fmt::format(
        "{:<34}{:>9.1f}{:>9.1f}{:>8.1f}{:>8.0f}%{:>8.2f}{:>8.2f}{:>8.2f}..{:<6.2f}\n", row.subject,
        1e3 * f.error_m, 1e3 * f.world_error_m, 1e3 * f.lag_s,
        raw_s > 0.0 ? 100.0 * f.lag_s / raw_s : 0.0, f.jerk, f.slide, f.play_least, f.play_most);
  }
  return text;
}

std::string stream_json(const std::vector<StreamRow>& rows) {
  nlohmann::ordered_json report = nlohmann::ordered_json::array();
  for (const StreamRow& row : rows) {
    const StreamFigures& f = row.figures;
    report.push_back({{"shown", row.subject},
                      {"error_mm", 1e3 * f.error_m},
                      {"world_error_mm", 1e3 * f.world_error_m},
                      {"lag_ms", 1e3 * f.lag_s},
                      {"jerk", f.jerk},
                      {"feet", f.slide},
                      {"play_least", f.play_least},
                      {"play_most", f.play_most},
                      {"seconds", f.seconds}});
  }
  return report.dump(2) + "\n";
}

}  // namespace dance
