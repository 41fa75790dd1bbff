#include "transformers/rhythm/dancer_music.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr Duration kEnough = Duration::ms(500);
constexpr Duration kTimeout = Duration::s(10);
constexpr Duration kFitted = Duration::s(2);
constexpr double kJump_beats = 0.5;
constexpr double kLeastTempo_hz = 20.0 / 60.0, kMostTempo_hz = 400.0 / 60.0;

}  // namespace

bool DancerMusic::add(MonoTime t, double beats) {
  bool jumped = false;
  if (count_ > 0) {
    if (t <= newest().time) return false;
    const double expected = beats_per_second_ > 0.0 ? position(t) : newest().beats;
    // Before the tempo is known a tag may be as far on as the fastest music gets.
    const double late_beats =
        beats_per_second_ > 0.0 ? 0.0 : kMostTempo_hz * (t - newest().time).as_seconds();
    jumped = std::abs(beats - expected) > kJump_beats + late_beats || beats < newest().beats;
    if (jumped) {
      count_ = 0;
      beats_per_second_ = 0.0;
    }
  }
  tags_[count_ % kTags] = {t, beats};
  ++count_;
  fit();
  return jumped;
}

void DancerMusic::fit() {
  // Least squares over two seconds, relative to the newest tag.
  const Tag& last = newest();
  double n = 0.0, st = 0.0, sb = 0.0, stt = 0.0, stb = 0.0;
  for (std::size_t i = size(); i-- > 0;) {
    const double t = (tag(i).time - last.time).as_seconds();
    if (-t > kFitted.as_seconds()) break;
    const double b = tag(i).beats - last.beats;
    n += 1.0;
    st += t;
    sb += b;
    stt += t * t;
    stb += t * b;
  }
  const double spread = n * stt - st * st;
  if (n < 2.0 || spread <= 1e-9) return;
  const double slope = (n * stb - st * sb) / spread;
  beats_per_second_ = std::clamp(slope, kLeastTempo_hz, kMostTempo_hz);
}

bool DancerMusic::is_known(MonoTime t) const {
  return size() >= 4 && newest().time - tag(0).time >= kEnough && t - newest().time < kTimeout;
}

double DancerMusic::position(MonoTime t) const {
  if (count_ == 0) return 0.0;
  const Tag& last = newest();
  if (t >= last.time) return last.beats + (t - last.time).as_seconds() * beats_per_second_;
  if (t < tag(0).time) return tag(0).beats + (t - tag(0).time).as_seconds() * beats_per_second_;
  std::size_t low = 0, high = size() - 1;  // tag(low) <= t < tag(high)
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (tag(middle).time <= t ? low : high) = middle;
  }
  const Tag &a = tag(low), &b = tag(high);
  return a.beats + (b.beats - a.beats) * (t - a.time).as_seconds() / (b.time - a.time).as_seconds();
}

MonoTime DancerMusic::time_of(double beats) const {
  if (count_ == 0 || beats_per_second_ <= 0.0) return MonoTime();
  const Tag& last = newest();
  if (beats >= last.beats)
    return last.time + Duration::seconds((beats - last.beats) / beats_per_second_);
  const Tag& first = tag(0);
  if (beats < first.beats)
    return first.time + Duration::seconds((beats - first.beats) / beats_per_second_);
  std::size_t low = 0, high = size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (tag(middle).beats <= beats ? low : high) = middle;
  }
  const Tag &a = tag(low), &b = tag(high);
  const double span = b.beats - a.beats;
  const double fraction = span > 0.0 ? (beats - a.beats) / span : 0.0;
  return a.time + Duration::seconds(fraction * (b.time - a.time).as_seconds());
}

}  // namespace dance
