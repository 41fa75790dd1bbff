#include "producers/music/beat_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/beat.h"

namespace dance {
namespace {

constexpr int kLongestBar_beats = 16;
constexpr double kLongestMusic_s = 12.0 * 3600.0;
constexpr std::size_t kTempoReach_beats = 2;
// A beat this far from a straight fit through its neighbours is a change of tempo, not jitter: 6 ms
// of jitter is 2 % of a beat at 180 BPM.
constexpr double kSteady_beats = 0.05;

std::string beat_name(std::size_t index) { return "beat " + std::to_string(index + 1); }

// The length that all bars have; 0 where they differ or none is known.
int regular_bar(std::span<const GridBeat> beats) {
  int longest = 0;
  for (const GridBeat& beat : beats) {
    if (beat.position == 0) return 0;
    longest = std::max(longest, beat.position);
  }
  for (std::size_t i = 1; i < beats.size(); ++i)
    if (beats[i].position != beats[i - 1].position % longest + 1) return 0;
  return longest;
}

}  // namespace

Result<BeatGrid> BeatGrid::make(std::span<const GridBeat> beats) {
  if (beats.size() < 2)
    return fail(std::to_string(beats.size()) + " beats; music needs at least two");
  if (beats.size() > kMostBeats) return fail("more than " + std::to_string(kMostBeats) + " beats");
  for (std::size_t i = 0; i < beats.size(); ++i) {
    const GridBeat& beat = beats[i];
    if (!(beat.time_s >= 0.0 && beat.time_s <= kLongestMusic_s))
      return fail(beat_name(i) + " is at no time between 0 and 12 hours");
    if (beat.position < 0 || beat.position > kLongestBar_beats)
      return fail(beat_name(i) + " has a position in the bar that is not 0 to 16");
    if (i == 0) continue;
    const double period_s = beat.time_s - beats[i - 1].time_s;
    if (!(period_s >= 60.0 / kMostTempo_bpm && period_s <= 60.0 / kLeastTempo_bpm))
      return fail(beat_name(i) + " comes " + std::to_string(period_s) +
                  " s after the one before; beats are 0.15 to 3 s apart (20 to 400 BPM)");
  }
  BeatGrid grid;
  grid.times_s_.reserve(beats.size());
  for (const GridBeat& beat : beats) grid.times_s_.push_back(beat.time_s);
  grid.beats_per_bar_ = regular_bar(beats);
  if (grid.beats_per_bar_ > 0) grid.first_beat_ = beats.front().position - 1;
  return grid;
}

double BeatGrid::beat_at(double time_s) const {
  if (time_s < times_s_.front())
    return first_beat_ - (times_s_.front() - time_s) / period_around_s(0);
  if (time_s >= times_s_.back())
    return last_beat() + (time_s - times_s_.back()) / period_around_s(size() - 1);
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
  const auto before = after - 1;
  return first_beat_ + static_cast<double>(before - times_s_.begin()) +
         (time_s - *before) / (*after - *before);
}

double BeatGrid::time_of(double beat) const {
  if (beat < first_beat_) return times_s_.front() - (first_beat_ - beat) * period_around_s(0);
  if (beat >= last_beat())
    return times_s_.back() + (beat - last_beat()) * period_around_s(size() - 1);
  const std::size_t i = interval_of_beat(beat);
  const double part = beat - first_beat_ - static_cast<double>(i);
  return times_s_[i] + part * (times_s_[i + 1] - times_s_[i]);
}

double BeatGrid::tempo_bpm(double beat) const {
  const double nearest =
      std::clamp(std::round(beat - first_beat_), 0.0, static_cast<double>(size() - 1));
  return 60.0 / period_around_s(static_cast<std::size_t>(nearest));
}

std::size_t BeatGrid::interval_of_beat(double beat) const {
  const double index =
      std::clamp(std::floor(beat - first_beat_), 0.0, static_cast<double>(size() - 2));
  return static_cast<std::size_t>(index);
}

// The slope of a least-squares fit through up to five beats.
double BeatGrid::period_around_s(std::size_t index) const {
  const std::size_t begin = index > kTempoReach_beats ? index - kTempoReach_beats : 0;
  const std::size_t end = std::min(index + kTempoReach_beats + 1, size());
  const auto count = static_cast<double>(end - begin);
  const double middle = (count - 1.0) / 2.0;
  double mean_s = 0.0;
  for (std::size_t i = begin; i < end; ++i) mean_s += times_s_[i] / count;
  double covariance = 0.0;
  double variance = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const double x = static_cast<double>(i - begin) - middle;
    covariance += x * (times_s_[i] - mean_s);
    variance += x * x;
  }
  const double period_s = covariance / variance;
  for (std::size_t i = begin; i < end; ++i) {
    const double line_s = mean_s + (static_cast<double>(i - begin) - middle) * period_s;
    if (std::abs(times_s_[i] - line_s) > kSteady_beats * period_s)
      return index > 0 ? times_s_[index] - times_s_[index - 1] : times_s_[1] - times_s_[0];
  }
  return period_s;
}

}  // namespace dance
