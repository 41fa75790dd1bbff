#include "viewer/practice/step_score.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// A slower foot shifts weight or slides; steps in place reach this.
constexpr float kStep_m_s = 0.6f;
constexpr Duration kLongestPause = Duration::ms(500);
// The music has jumped, or the dancer has stopped.
constexpr double kJumpBack_beats = 0.5;
constexpr double kRest_beats = 16.0;
// A step is known so long after it happened: one frame of a slow camera, and its transport.
constexpr double kKnownAfter_s = 0.15;

}  // namespace

int StepScore::Figures::met_count() const {
  return static_cast<int>(std::count(met.begin(), met.begin() + counted, true));
}

void StepScore::start_again() {
  open_.reset();
  count_ = 0;
}

void StepScore::add(const Pose& pose, const BeatClock& music) {
  const MonoTime t = pose.capture_time;
  if (last_.is_set() && t <= last_) return;
  if (last_.is_set() && t - last_ > kLongestPause) {
    channels_.forget();
    steps_.forget();
  }
  last_ = t;
  const std::size_t fresh = steps_.add(channels_.take(pose));
  if (!music.is_known(t)) return start_again();
  const double here = music.position(t);
  if (here < here_ - kJumpBack_beats || here > here_ + kRest_beats) start_again();
  here_ = here;
  for (std::size_t i = fresh; i-- > 0;) {
    const MotionBeat& step = steps_.newest(i);
    if (step.is_foot_fall() && step.strength >= kStep_m_s)
      note_step(music.position(step.time), music.beats_per_second());
  }
  if (open_ && here > open_->beat + 0.5 + kKnownAfter_s * music.beats_per_second()) close();
  const bool has_stopped = count_ > 0 && here > beats_[(count_ - 1) % kBeats].beat + kRest_beats;
  if (has_stopped && !open_) start_again();
}

void StepScore::note_step(double at, double beats_per_second) {
  const double beat = std::round(at);
  if (count_ > 0 && beat <= beats_[(count_ - 1) % kBeats].beat) return;
  if (open_ && beat < open_->beat) return;
  if (open_ && beat > open_->beat) close();
  const double late = at - beat;
  if (open_ && std::abs(late) >= std::abs(open_->late_beats)) return;
  open_ = Beat{beat, late, 1e3 * late / beats_per_second};
}

void StepScore::close() {
  beats_[count_++ % kBeats] = *open_;
  open_.reset();
}

StepScore::Figures StepScore::figures() const {
  Figures figures;
  const std::size_t n = std::min(count_, static_cast<std::size_t>(kBeats));
  figures.counted = static_cast<int>(n);
  double late_ms = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Beat& beat = beats_[(count_ - n + i) % kBeats];
    figures.met[i] = std::abs(beat.late_ms) <= kTolerance.as_ms() &&
                     std::abs(beat.late_beats) <= kTolerance_beats;
    late_ms += beat.late_ms / static_cast<double>(n);
  }
  figures.late_ms = static_cast<float>(late_ms);
  return figures;
}

}  // namespace dance
