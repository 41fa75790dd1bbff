#include "testing/music/beat_score.h"

#include <algorithm>
#include <cmath>

namespace dance {

BeatScore score_beats(std::span<const double> truth_s, std::span<const double> told_s,
                      double from_s, double to_s) {
  const auto within = [&](double t) { return t >= from_s && t < to_s; };
  std::vector<double> truth;
  std::vector<double> told;
  std::copy_if(truth_s.begin(), truth_s.end(), std::back_inserter(truth), within);
  std::copy_if(told_s.begin(), told_s.end(), std::back_inserter(told), within);
  BeatScore score{.truth = static_cast<int>(truth.size()), .told = static_cast<int>(told.size())};
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0, j = 0; i < truth.size() && j < told.size();) {
    const double error = told[j] - truth[i];
    if (std::abs(error) > kBeatTolerance_s) {
      ++(error < 0.0 ? j : i);
      continue;
    }
    ++score.hits;
    sum += error;
    squares += error * error;
    ++i;
    ++j;
  }
  if (score.hits == 0) return score;
  score.mean_error_s = sum / score.hits;
  score.sd_error_s =
      std::sqrt(std::max(0.0, squares / score.hits - score.mean_error_s * score.mean_error_s));
  return score;
}

void PredictedBeats::hear(const Beat& beat) {
  if (begun_ && beat.beat > number_ && promised_) times_s_.push_back(promised_s_);
  if (!begun_ || beat.beat != number_) promised_ = false;
  begun_ = true;
  number_ = beat.beat;
  // A rounding of the clock is no shorter notice.
  if (!beat.playing || (beat.beat_time - beat.time).as_seconds() < hop_s_ - 1e-6) return;
  promised_ = true;
  promised_s_ = (beat.beat_time - MonoTime{}).as_seconds();
}

}  // namespace dance
