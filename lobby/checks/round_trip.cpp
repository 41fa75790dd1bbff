#include "lobby/checks/round_trip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobby/checks/test_sound.h"

namespace dance {
namespace {

constexpr double kSampleRate_hz = 48'000.0;
constexpr std::size_t kMostSamples =
    static_cast<std::size_t>(RoundTripMeter::kLongest_s * kSampleRate_hz) + kSweepSamples;
constexpr float kLike = 0.35f;  // in a room with reflections and noise; noise alone reaches 0.1
constexpr float kQuietest_gain = 1e-5f;

double energy(std::span<const float> samples) {
  double sum = 0.0;
  for (const float s : samples) sum += static_cast<double>(s) * static_cast<double>(s);
  return sum;
}

// In lanes, as a compiler can then compute several at once.
float product_of(std::span<const float> heard, std::span<const float, kSweepSamples> sweep) {
  constexpr std::size_t kLanes = 8;
  static_assert(kSweepSamples % kLanes == 0);
  std::array<float, kLanes> sums{};
  for (std::size_t i = 0; i < sweep.size(); i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      sums[lane] += heard[i + lane] * sweep[i + lane];
  float sum = 0.0f;
  for (const float lane : sums) sum += lane;
  return sum;
}

}  // namespace

SweepPlace find_sweep(std::span<const float> heard) {
  SweepPlace best;
  const auto sweep = test_sweep();
  if (heard.size() < sweep.size()) return best;
  const double sweep_energy = energy(sweep);
  double window = energy(heard.first(sweep.size()));
  for (std::size_t at = 0; at + sweep.size() <= heard.size(); ++at) {
    if (at > 0) {
      const auto in = static_cast<double>(heard[at + sweep.size() - 1]);
      const auto out = static_cast<double>(heard[at - 1]);
      window = std::max(0.0, window + in * in - out * out);
    }
    // What is next to nothing is alike to anything.
    if (window < 1e-9) continue;
    const float product = product_of(heard.subspan(at, sweep.size()), sweep);
    const auto likeness = static_cast<float>(std::abs(product) / std::sqrt(window * sweep_energy));
    if (likeness <= best.likeness) continue;
    best = {at, likeness, static_cast<float>(std::abs(product) / sweep_energy)};
  }
  return best;
}

RoundTripMeter::RoundTripMeter() { heard_.reserve(kMostSamples); }

void RoundTripMeter::begin(MonoTime played) {
  is_listening_ = true;
  played_ = played;
  first_.reset();
  heard_.clear();
  found_.reset();
}

void RoundTripMeter::hear(std::span<const float> samples, MonoTime read) {
  if (!is_listening_ || samples.empty()) return;
  if (!first_)
    first_ = read - Duration::seconds(static_cast<double>(samples.size()) / kSampleRate_hz);
  const std::size_t room = kMostSamples - heard_.size();
  const auto kept = samples.first(std::min(room, samples.size()));
  heard_.insert(heard_.end(), kept.begin(), kept.end());
  if (heard_.size() < kMostSamples) return;
  is_listening_ = false;
  found_ = find();
}

RoundTrip RoundTripMeter::find() const {
  const SweepPlace place = find_sweep(heard_);
  RoundTrip trip;
  trip.likeness = place.likeness;
  trip.is_heard = place.likeness >= kLike;
  trip.delay =
      *first_ + Duration::seconds(static_cast<double>(place.at) / kSampleRate_hz) - played_;
  trip.echo_db = 20.0f * std::log10(std::max(place.gain, kQuietest_gain));
  return trip;
}

std::optional<RoundTrip> RoundTripMeter::take() {
  std::optional<RoundTrip> taken;
  std::swap(taken, found_);
  return taken;
}

}  // namespace dance
