#include "viewer/replay/timeline/timeline_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace dance {
namespace {

constexpr std::array kSteps_s{0.1,  0.2,  0.5,   1.0,   2.0,   5.0,    10.0,   15.0,
                              30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0, 7200.0};
constexpr std::array kBarStrides{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024};
// Beats further apart than at 20 a minute do not belong together.
constexpr Duration kLongestBeat = Duration::ms(3100);
constexpr double kNotch = 1.25;

using Beats = std::vector<ReplayIndex::WholeBeat>;

Beats::const_iterator first_at(const Beats& beats, MonoTime moment) {
  return std::lower_bound(beats.begin(), beats.end(), moment,
                          [](const auto& beat, MonoTime t) { return beat.time < t; });
}

int bar_of(const ReplayIndex::WholeBeat& beat) {
  const int in_bar = beat.beats_per_bar > 0 ? beat.beats_per_bar : 4;
  return static_cast<int>(std::floor(beat.beat / in_bar)) + 1;
}
int beat_in_bar(const ReplayIndex::WholeBeat& beat) {
  const int in_bar = beat.beats_per_bar > 0 ? beat.beats_per_bar : 4;
  return static_cast<int>(beat.beat - (bar_of(beat) - 1.0) * in_bar) + 1;
}

}  // namespace

double TimelineScale::pixels_per_second() const {
  const double seconds = (to_ - from_).as_seconds();
  return seconds > 0.0 ? static_cast<double>(right_px_ - left_px_) / seconds : 0.0;
}

float TimelineScale::x_of(MonoTime moment) const {
  return left_px_ + static_cast<float>((moment - from_).as_seconds() * pixels_per_second());
}

MonoTime TimelineScale::moment_at(float x_px) const {
  const double width = static_cast<double>(std::max(1.0f, right_px_ - left_px_));
  const double share = std::clamp(static_cast<double>(x_px - left_px_) / width, 0.0, 1.0);
  return from_ + Duration::seconds(share * (to_ - from_).as_seconds());
}

void TimelineScale::hold(Duration length) {
  length = std::clamp(length, std::min(kShortest, end_ - begin_), end_ - begin_);
  from_ = std::clamp(from_, begin_, end_ - length);
  to_ = from_ + length;
}

void TimelineScale::zoom(float notches, float x_px) {
  const MonoTime there = moment_at(x_px);
  const double factor = std::pow(kNotch, -static_cast<double>(notches));
  const double before_s = (there - from_).as_seconds() * factor;
  const Duration length = Duration::seconds((to_ - from_).as_seconds() * factor);
  from_ = there - Duration::seconds(before_s);
  hold(length);
}

void TimelineScale::follow(MonoTime moment) {
  if (moment >= from_ && moment <= to_) return;
  const Duration length = to_ - from_;
  from_ = moment - length / 10;
  hold(length);
}

double TimelineScale::label_step_s(float least_px) const {
  for (const double step_s : kSteps_s)
    if (step_s * pixels_per_second() >= static_cast<double>(least_px)) return step_s;
  return kSteps_s.back() * 4.0;
}

std::string clock_text(double seconds, double step_s) {
  const double tenths = std::floor(std::max(0.0, seconds) * 10.0 + 0.5);
  const auto whole = static_cast<long>(step_s < 1.0 ? tenths / 10.0 : seconds + 1e-6);
  std::array<char, 48> text{};
  if (whole >= 3600)
    std::snprintf(text.data(), text.size(), "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60,
                  whole % 60);
  else
    std::snprintf(text.data(), text.size(), "%ld:%02ld", whole / 60, whole % 60);
  std::string shown = text.data();
  if (step_s < 1.0) shown += "." + std::to_string(static_cast<long>(tenths) % 10);
  return shown;
}

std::vector<BeatTick> beat_ticks(const Beats& beats, const TimelineScale& scale, float least_px,
                                 float label_px) {
  std::vector<BeatTick> ticks;
  const auto first = first_at(beats, scale.from());
  const auto last = first_at(beats, scale.to());
  if (last - first < 1) return ticks;
  const double seconds = (scale.to() - scale.from()).as_seconds();
  const double beat_s = std::min(seconds / static_cast<double>(last - first), 3.0);
  const double beat_px = beat_s * scale.pixels_per_second();
  const int in_bar = first->beats_per_bar > 0 ? first->beats_per_bar : 4;
  const auto stride_for = [&](double wanted_px) {
    for (const int stride : kBarStrides)
      if (beat_px * in_bar * stride >= wanted_px) return stride;
    return kBarStrides.back();
  };
  const bool shows_beats = beat_px >= static_cast<double>(least_px);
  const int tick_stride = stride_for(static_cast<double>(least_px));
  const int label_stride = stride_for(static_cast<double>(label_px));
  for (auto beat = first; beat != last; ++beat) {
    const bool is_first_in_bar = beat_in_bar(*beat) == 1;
    const int bar = bar_of(*beat);
    const bool is_marked = is_first_in_bar && (bar - 1) % tick_stride == 0;
    if (!shows_beats && !is_marked) continue;
    ticks.push_back(
        {beat->time, is_first_in_bar, bar, is_first_in_bar && (bar - 1) % label_stride == 0});
  }
  return ticks;
}

std::string bar_text(const Beats& beats, MonoTime moment) {
  auto beat = first_at(beats, moment + Duration::us(1));
  if (beat == beats.begin() || moment - (beat - 1)->time > kLongestBeat) return "";
  --beat;
  if (beat->beats_per_bar == 0) return "beat " + std::to_string(std::lround(beat->beat));
  return "bar " + std::to_string(bar_of(*beat)) + ", beat " + std::to_string(beat_in_bar(*beat));
}

double tempo_at(const Beats& beats, MonoTime moment) {
  auto next = first_at(beats, moment);
  if (next == beats.begin() && next != beats.end()) ++next;
  if (next == beats.end() && !beats.empty()) --next;
  if (next == beats.end() || next == beats.begin()) return 0.0;
  const auto before = next - 1;
  const double seconds = (next->time - before->time).as_seconds();
  const bool is_near = moment > before->time - kLongestBeat && moment < next->time + kLongestBeat;
  if (!is_near || !(seconds > 0.0) || next->beat - before->beat != 1.0) return 0.0;
  return 60.0 / seconds;
}

}  // namespace dance
