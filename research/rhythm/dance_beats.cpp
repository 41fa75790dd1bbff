#include "research/rhythm/dance_beats.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "transformers/tempo/motion_channels.h"

namespace dance {
namespace {

using Complex = std::complex<double>;

constexpr double kWindow_s = 12.0;
constexpr std::size_t kPlaces = 64;  // of four counts
constexpr double kPlacesPerBeat = 16.0;
constexpr double kSlowest_bpm = 110.0, kFastest_bpm = 215.0, kTempoStep_bpm = 1.0;
// What it costs to move by a beat in half a second, squared; and the most that is tried, in places.
constexpr double kMoveCost = 6.0;
constexpr int kMostMove = 3;

using Fit = std::array<double, kPlaces>;

using Harmonics = std::array<Complex, StepPattern::kHarmonics>;

Harmonics powers_of(Complex turn) {
  Harmonics harmonics;
  Complex harmonic = 1.0;
  for (Complex& h : harmonics) h = harmonic *= turn;
  return harmonics;
}

Complex turn_of(double parts) { return std::polar(1.0, -2.0 * std::numbers::pi * parts); }

// Both feet's waves around each half second: how well each place of four counts fits.
std::vector<Fit> fits_of(const SeenSteps& steps, double tempo_bpm, const StepPattern& pattern) {
  std::vector<Harmonics> turns;
  for (const StepSigns::Slot& slot : steps)
    turns.push_back(powers_of(turn_of(tempo_bpm / 60.0 / StepPattern::kCounts *
                                      (slot.middle - MonoTime()).as_seconds())));
  std::array<Harmonics, 2 * kPlaces> back;
  for (std::size_t place = 0; place < back.size(); ++place)
    back[place] = powers_of(turn_of(static_cast<double>(place) / (2.0 * kPlaces)));
  const double last_s = (steps.back().middle - MonoTime()).as_seconds();
  std::vector<Fit> fits;
  for (double at_s = 0.0; at_s <= last_s; at_s += DanceBeats::kEvery_s) {
    // Of both feet, against the pattern's.
    Harmonics wave{};
    double weights = 0.0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const double off_s = (steps[i].middle - MonoTime()).as_seconds() - at_s;
      if (std::abs(off_s) >= 0.5 * kWindow_s) continue;
      const double root = std::cos(std::numbers::pi * off_s / kWindow_s);
      const double weight = root * root;
      weights += weight;
      for (std::size_t h = 0; h < StepPattern::kHarmonics; ++h)
        for (std::size_t foot = 0; foot < 2; ++foot)
          wave[h] += 2.0 * weight * static_cast<double>(steps[i].sign[foot]) * turns[i][h] *
                     std::conj(Complex(pattern.wave[foot][h]));
    }
    Fit& fit = fits.emplace_back();
    fit.fill(-1e9);
    for (std::size_t place = 0; place < 2 * kPlaces; ++place) {
      double sum = 0.0;
      for (std::size_t h = 0; h < StepPattern::kHarmonics; ++h)
        sum += (wave[h] * back[place][h]).real();
      fit[place % kPlaces] = std::max(fit[place % kPlaces], sum / std::max(weights, 1e-9));
    }
  }
  return fits;
}

// The way through all half seconds that fits best and moves least; its worth a half second.
double best_way(const std::vector<Fit>& fits, std::vector<std::size_t>& way) {
  std::vector<std::array<int, kPlaces>> came(fits.size());
  Fit score = fits[0];
  for (std::size_t i = 1; i < fits.size(); ++i) {
    Fit next;
    for (std::size_t place = 0; place < kPlaces; ++place) {
      double best = -1e18;
      for (int move = -kMostMove; move <= kMostMove; ++move) {
        const auto from =
            static_cast<std::size_t>(static_cast<int>(place + kPlaces) - move) % kPlaces;
        const double beats = move / kPlacesPerBeat;
        const double worth = score[from] - kMoveCost * beats * beats;
        if (worth <= best) continue;
        best = worth;
        came[i][place] = static_cast<int>(from);
      }
      next[place] = best + fits[i][place];
    }
    score = next;
  }
  const auto best = std::max_element(score.begin(), score.end());
  way.assign(fits.size(), static_cast<std::size_t>(best - score.begin()));
  for (std::size_t i = fits.size(); i-- > 1;)
    way[i - 1] = static_cast<std::size_t>(came[i][way[i]]);
  return *best / static_cast<double>(fits.size());
}

}  // namespace

SeenSteps steps_of(const Skeleton& skeleton, std::span<const Pose> poses, double hz) {
  MotionChannels channels;
  channels.set_body(skeleton);
  StepSigns signs;
  SeenSteps steps;
  Pose pose;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    pose = poses[i];
    pose.capture_time = MonoTime() + Duration::seconds(static_cast<double>(i) / hz);
    const std::size_t count = signs.add(channels.take(pose));
    for (std::size_t k = 0; k < count; ++k) steps.push_back(signs.slot(k));
  }
  return steps;
}

double DanceBeats::beats_at(double t_s) const {
  const double at = std::clamp(t_s / kEvery_s, 0.0, static_cast<double>(offset_beats.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), offset_beats.size() - 2);
  const double part = at - static_cast<double>(i);
  return t_s * tempo_bpm / 60.0 + offset_beats[i] + part * (offset_beats[i + 1] - offset_beats[i]);
}

double DanceBeats::time_of(double beats) const {
  // Offsets move by less than the tempo: beats only grow.
  double low = -60.0, high = kEvery_s * static_cast<double>(offset_beats.size()) + 60.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (beats_at(middle) < beats ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double DanceBeats::strength_at(double t_s) const {
  const double at = std::clamp(t_s / kEvery_s, 0.0, static_cast<double>(strength.size() - 1));
  return strength[static_cast<std::size_t>(at)];
}

DanceBeats find_dance_beats(std::span<const SeenSteps> dancers, const StepPattern& pattern) {
  DanceBeats beats;
  double most = -1e18;
  std::vector<std::size_t> way;
  for (double bpm = kSlowest_bpm; bpm <= kFastest_bpm; bpm += kTempoStep_bpm) {
    std::vector<Fit> fits;
    for (const SeenSteps& steps : dancers) {
      const std::vector<Fit> own = fits_of(steps, bpm, pattern);
      if (fits.empty()) fits = std::vector<Fit>(own.size(), Fit{});
      fits.resize(std::min(fits.size(), own.size()));
      for (std::size_t i = 0; i < fits.size(); ++i)
        for (std::size_t p = 0; p < kPlaces; ++p) fits[i][p] += own[i][p];
    }
    const double worth = best_way(fits, way);
    if (worth <= most) continue;
    most = worth;
    beats.tempo_bpm = bpm;
    beats.offset_beats.clear();
    beats.strength.clear();
    for (std::size_t i = 0; i < fits.size(); ++i) {
      const std::size_t p = way[i];
      const double a = fits[i][(p + kPlaces - 1) % kPlaces], b = fits[i][p],
                   c = fits[i][(p + 1) % kPlaces];
      const double bend = a - 2.0 * b + c;
      const double top = bend < 0.0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0;
      double offset = (static_cast<double>(p) + top) / kPlacesPerBeat;
      if (i > 0) offset += 4.0 * std::round((beats.offset_beats.back() - offset) / 4.0);
      beats.offset_beats.push_back(offset);
      beats.strength.push_back(b);
    }
  }
  return beats;
}

StepPattern learn_steps(std::span<const KnownDance> dances, const StepPattern& like) {
  // Blocks of some seconds: a dancer may begin a figure with the other foot.
  constexpr std::size_t kBlock = 40;
  StepPattern learnt;
  std::array<std::array<Complex, StepPattern::kHarmonics>, StepPattern::kSigns> sum{};
  std::array<double, StepPattern::kSigns> power{};
  double slots = 0.0;
  for (const KnownDance& dance : dances) {
    for (std::size_t begin = 0; begin + kBlock <= dance.steps->size(); begin += kBlock) {
      std::array<std::array<Complex, StepPattern::kHarmonics>, StepPattern::kSigns> wave{};
      std::array<double, StepPattern::kSigns> square{};
      bool is_strong = true;
      for (std::size_t i = begin; i < begin + kBlock; ++i) {
        const StepSigns::Slot& slot = (*dance.steps)[i];
        const double t_s = (slot.middle - MonoTime()).as_seconds();
        is_strong = is_strong && dance.beats->strength_at(t_s) >= dance.least_strength;
        const Complex turn = std::polar(
            1.0, -2.0 * std::numbers::pi * dance.beats->beats_at(t_s) / StepPattern::kCounts);
        Complex harmonic = 1.0;
        for (std::size_t h = 0; h < StepPattern::kHarmonics; ++h) {
          harmonic *= turn;
          for (std::size_t s = 0; s < StepPattern::kSigns; ++s)
            wave[s][h] += 2.0 * static_cast<double>(slot.sign[s]) * harmonic;
        }
        for (std::size_t s = 0; s < StepPattern::kSigns; ++s)
          square[s] += static_cast<double>(slot.sign[s]) * static_cast<double>(slot.sign[s]);
      }
      if (!is_strong) continue;
      double odd = 0.0;  // of the fit: the other half of the eight counts has its opposite
      for (std::size_t foot = 0; foot < 2; ++foot)
        for (std::size_t h = 0; h < StepPattern::kHarmonics; h += 2)
          odd += (wave[foot][h] * std::conj(Complex(like.wave[foot][h]))).real();
      for (std::size_t s = 0; s < StepPattern::kSigns; ++s) {
        power[s] += square[s];
        for (std::size_t h = 0; h < StepPattern::kHarmonics; ++h)
          sum[s][h] += odd < 0.0 && h % 2 == 0 ? -wave[s][h] : wave[s][h];
      }
      slots += static_cast<double>(kBlock);
    }
  }
  if (slots == 0.0) return like;
  for (std::size_t s = 0; s < StepPattern::kSigns; ++s)
    for (std::size_t h = 0; h < StepPattern::kHarmonics; ++h)
      learnt.wave[s][h] = std::complex<float>(sum[s][h] / slots);
  learnt.mirror();
  for (std::size_t s = 0; s < StepPattern::kSigns; ++s) {
    // Left and right foot have one scale.
    const double all = s < 2 ? (power[0] + power[1]) / (2.0 * slots) : power[s] / slots;
    double told = 0.0;
    for (const auto& w : learnt.wave[s]) told += 0.5 * std::norm(Complex(w));
    learnt.power[s] = static_cast<float>(all);
    learnt.spread[s] = static_cast<float>(std::max(0.15, all - told));
  }
  return learnt;
}

}  // namespace dance
