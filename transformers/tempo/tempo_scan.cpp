#include "transformers/tempo/tempo_scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dance {
namespace {

constexpr double kScan_hz = 10.0;
constexpr double kLowest_hz = 0.125;  // two bars at 60 BPM
// Each of the two poles: together they look back about eight seconds.
constexpr double kPole_s = 4.0;
constexpr float kPole = static_cast<float>(1.0 / (kPole_s * kScan_hz));
constexpr int kLowestBeatBin = 144;  // 60 BPM
// Another tempo must be this much better before it is believed: the dance has not changed, the
// figure has.
constexpr float kBetter = 1.2f;
constexpr int kScansBeforeWord = 30;
// Less of the motion than this is no tempo: somebody stands, or walks about.
constexpr float kLeastScore = 0.05f;

// In bins from the beat: a bar's quarter, half, three quarters; and for places of two bars.
constexpr std::array<int, 4> kStepHarmonics{-96, -48, -20, 0};
constexpr std::array<int, 4> kPlaceHarmonics{-144, -96, -68, -48};

double bin_hz(double bin) { return kLowest_hz * std::exp2(bin / 48.0); }

}  // namespace

TempoScan::TempoScan() { forget(); }

void TempoScan::forget() {
  for (std::size_t k = 0; k < kBins; ++k) {
    const double turn = -2.0 * std::numbers::pi * bin_hz(static_cast<double>(k)) / kScan_hz;
    bins_[k] = Bin();
    bins_[k].step_re = static_cast<float>(std::cos(turn));
    bins_[k].step_im = static_cast<float>(std::sin(turn));
  }
  power_places_ = {};
  power_steps_ = {};
  sum_ = {};
  scanned_ = {};
  energy_places_ = {};
  energy_steps_ = {};
  part_ = 0;
  tempo_bpm_ = 0.0;
  score_ = 0.0f;
  scans_ = 0;
}

void TempoScan::add(const Sample& sample) {
  for (std::size_t c = 0; c < kChannels; ++c) sum_[c] += sample[c];
  turn(part_ * kBins / kParts, (part_ + 1) * kBins / kParts);
  if (++part_ < kParts) return;
  part_ = 0;
  ++scans_;
  choose();
  // What the next round of parts takes in.
  float places = 0.0f;
  for (std::size_t c = 0; c < kChannels; ++c) {
    scanned_[c] = sum_[c] / static_cast<float>(kParts);
    if (c < kPlaces) places += scanned_[c] * scanned_[c];
  }
  sum_ = {};
  const float steps = scanned_[kPlaces] * scanned_[kPlaces];
  energy_places_[0] += kPole * (places - energy_places_[0]);
  energy_places_[1] += kPole * (energy_places_[0] - energy_places_[1]);
  energy_steps_[0] += kPole * (steps - energy_steps_[0]);
  energy_steps_[1] += kPole * (energy_steps_[0] - energy_steps_[1]);
}

void TempoScan::turn(std::size_t begin, std::size_t end) {
  for (std::size_t k = begin; k < end; ++k) {
    Bin& bin = bins_[k];
    const float re = bin.re * bin.step_re - bin.im * bin.step_im;
    const float im = bin.re * bin.step_im + bin.im * bin.step_re;
    // One Newton step keeps the turn on the unit circle for ever.
    const float unit = 1.5f - 0.5f * (re * re + im * im);
    bin.re = re * unit;
    bin.im = im * unit;
    float places = 0.0f;
    for (std::size_t c = 0; c < kChannels; ++c) {
      bin.first_re[c] += kPole * (scanned_[c] * bin.re - bin.first_re[c]);
      bin.first_im[c] += kPole * (scanned_[c] * bin.im - bin.first_im[c]);
      bin.second_re[c] += kPole * (bin.first_re[c] - bin.second_re[c]);
      bin.second_im[c] += kPole * (bin.first_im[c] - bin.second_im[c]);
    }
    for (std::size_t c = 0; c < kPlaces; ++c)
      places += bin.second_re[c] * bin.second_re[c] + bin.second_im[c] * bin.second_im[c];
    power_places_[k] = places;
    power_steps_[k] = bin.second_re[kPlaces] * bin.second_re[kPlaces] +
                      bin.second_im[kPlaces] * bin.second_im[kPlaces];
  }
}

float TempoScan::score_of(std::size_t beat_bin) const {
  const auto sum = [&](const std::array<float, kBins>& power, const std::array<int, 4>& offsets) {
    float total = 0.0f;
    for (const int offset : offsets)
      total += power[static_cast<std::size_t>(static_cast<int>(beat_bin) + offset)];
    return total;
  };
  // A line's power is a quarter of its amplitude squared, its energy a half; places and steps count
  // alike.
  constexpr float kTiny = 1e-9f;
  return sum(power_places_, kPlaceHarmonics) / (energy_places_[1] + kTiny) +
         sum(power_steps_, kStepHarmonics) / (energy_steps_[1] + kTiny);
}

float TempoScan::score_at(double bpm) const {
  const double bin = kLowestBeatBin + kBinsPerOctave * std::log2(bpm / 60.0);
  if (scans_ < kScansBeforeWord || !(bin > kLowestBeatBin && bin < static_cast<double>(kBins - 1)))
    return 0.0f;
  return score_of(static_cast<std::size_t>(std::lround(bin)));
}

void TempoScan::choose() {
  if (scans_ < kScansBeforeWord) return;
  const auto weighed = [&](std::size_t bin) {
    const double octaves =
        std::log2(bin_hz(static_cast<double>(bin)) * 60.0 / kUsual_bpm) / kUsualWidth_octaves;
    return score_of(bin) * static_cast<float>(std::exp(-0.5 * octaves * octaves));
  };
  std::array<float, kBins> score{};
  std::size_t best = kLowestBeatBin + 1;
  for (std::size_t k = kLowestBeatBin; k < kBins; ++k) score[k] = weighed(k);
  for (std::size_t k = kLowestBeatBin + 1; k + 1 < kBins; ++k)
    if (score[k] > score[best]) best = k;
  if (tempo_bpm_ > 0.0) {
    // The peak that the tempo so far stands on.
    const int at =
        static_cast<int>(std::lround(kBinsPerOctave * std::log2(tempo_bpm_ / 60.0 / kLowest_hz)));
    std::size_t kept = static_cast<std::size_t>(at);
    for (int k = std::max(at - 2, kLowestBeatBin + 1);
         k <= std::min(at + 2, static_cast<int>(kBins) - 2); ++k)
      if (score[static_cast<std::size_t>(k)] > score[kept]) kept = static_cast<std::size_t>(k);
    if (score[best] < kBetter * score[kept]) best = kept;
  }
  best = std::clamp<std::size_t>(best, kLowestBeatBin + 1, kBins - 2);
  score_ = score_of(best);
  if (tempo_bpm_ == 0.0 && score_ < kLeastScore) return;
  // Top of the parabola through three bins.
  const float a = score[best - 1], b = score[best], c = score[best + 1];
  const float bend = a - 2.0f * b + c;
  const float top = bend < 0.0f ? std::clamp(0.5f * (a - c) / bend, -0.5f, 0.5f) : 0.0f;
  tempo_bpm_ = 60.0 * bin_hz(static_cast<double>(best) + static_cast<double>(top));
}

}  // namespace dance
