#include "research/lapse/lapse_eval.h"

#include <algorithm>
#include <cmath>

#include "testing/motion/motion_measures.h"

namespace dance {
namespace {

// Frames of a trial: what was danced, and what was shown.
struct Trial {
  std::vector<Pose> danced, shown;
  std::size_t lapse_begin = 0, lapse_end = 0;  // [begin, end) had no pose
};

Trial run_trial(const CodecTake& take, StageSubject& subject, std::size_t last_seen,
                std::size_t length, std::size_t after) {
  Trial trial;
  // What peaks are compared with, too.
  const auto before = static_cast<std::size_t>(4.0 * take.hz);
  const std::size_t end = last_seen + 1 + length + after;
  for (std::size_t i = 0; i < end; ++i) {
    const MonoTime now = take.poses[i].capture_time;
    if (i <= last_seen || i > last_seen + length) subject.observe(take.poses[i], now);
    if (i + before <= last_seen) continue;
    Pose shown;
    if (!subject.sample(now, shown)) shown = take.poses[i];
    if (i == last_seen + 1) trial.lapse_begin = trial.shown.size();
    trial.danced.push_back(take.poses[i]);
    trial.shown.push_back(shown);
  }
  trial.lapse_end = trial.lapse_begin + length;
  return trial;
}

struct Sums {
  double error = 0.0, danced = 0.0, shown = 0.0, danced_body = 0.0, shown_body = 0.0;
  double return_error = 0.0;
};

void add_trial(const CodecTake& take, const Trial& trial, Sums& sums, LapseFigures& figures) {
  const JointTrack danced(take.skeleton, trial.danced, take.hz);
  const JointTrack shown(take.skeleton, trial.shown, take.hz);
  const std::size_t begin = trial.lapse_begin, end = trial.lapse_end;
  const auto frames_of = [&](double s) { return static_cast<std::size_t>(s * take.hz); };
  sums.error += body_error_m(shown, danced, begin, end);
  sums.danced += activity_m_s(danced, Places::kWorld, begin, end);
  sums.shown += activity_m_s(shown, Places::kWorld, begin, end);
  sums.danced_body += activity_m_s(danced, Places::kBody, begin, end);
  sums.shown_body += activity_m_s(shown, Places::kBody, begin, end);
  const std::size_t settled = end + frames_of(0.3);
  sums.return_error += world_error_m(shown, danced, settled, settled + 1);
  const double own = peak_speed_m_s(danced, Places::kWorld, 0, danced.size());
  const std::size_t started = std::min(end, begin + frames_of(0.2));
  const auto keep_peak = [&](double& most, std::size_t from, std::size_t to) {
    most = std::max(most, peak_speed_m_s(shown, Places::kWorld, from, to) / own);
  };
  keep_peak(figures.start_peak, begin, started);
  keep_peak(figures.wrap_peak, started, end);
  keep_peak(figures.return_peak, end, end + frames_of(0.5));
  const Eigen::Vector3f home = trial.shown[begin - 1].p_WH_m;
  for (std::size_t i = begin; i < end; ++i) {
    Eigen::Vector3f away = trial.shown[i].p_WH_m - home;
    away.y() = 0.0f;
    figures.root_drift_m = std::max(figures.root_drift_m, static_cast<double>(away.norm()));
  }
  ++figures.trials;
}

}  // namespace

LapseFigures evaluate_lapse(const std::vector<CodecTake>& takes, const MakeSubject& make,
                            Duration length, const LapseOptions& options) {
  LapseFigures figures;
  Sums sums;
  for (const CodecTake& take : takes) {
    const auto frames_of = [&](Duration d) {
      return static_cast<std::size_t>(std::lround(d.as_seconds() * take.hz));
    };
    const std::size_t frames = frames_of(length), after = frames_of(Duration::ms(600));
    for (std::size_t seen = frames_of(options.warm_up);
         seen + frames + after + 1 < take.poses.size(); seen += frames_of(options.every)) {
      const auto subject = make(take.skeleton);
      add_trial(take, run_trial(take, *subject, seen, frames, after), sums, figures);
    }
  }
  if (figures.trials == 0) return figures;
  figures.error_m = sums.error / figures.trials;
  figures.return_error_m = sums.return_error / figures.trials;
  figures.activity = sums.shown / sums.danced;
  figures.body_activity = sums.shown_body / sums.danced_body;
  return figures;
}

}  // namespace dance
