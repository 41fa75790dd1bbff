#include "transformers/tempo/step_pointer.h"

#include <algorithm>
#include <cmath>

#include "transformers/tempo/tempo_scan.h"

namespace dance {
namespace {

// Signs of one slot are much like those of the last one, and of each other: each counts as this
// part of one that were independent.
constexpr float kIndependent = 0.15f;
constexpr float kMostEvidence = 20.0f;
// Of a tempo against the music's: how far apart two rows are, and how far off it usually is.
constexpr double kTempoStep = 0.01, kTempoSpread = 0.01;
constexpr float kTempoChange = 0.02f;  // per slot, to each side
// Dancers' tempo against the music's is learnt in so many seconds of being sure: two houses'
// musics, or a band's, differ steadily by a percent or two, and a filter that does not expect it
// lags.
constexpr double kUsualTaken_s = 10.0;
constexpr double kMostUsual = 0.03;
// By how much dancers wander about their own count, squared, counts² a second.
constexpr double kWander = 0.05 * 0.05;
constexpr float kNothingAtFirst = 0.8f;
constexpr float kBegins = 0.005f, kEnds = 0.005f;  // dancing the pattern, per slot
// What is stepped, in counts a minute, and where most of it lies: tells half and double apart.
constexpr double kSlowest_bpm = 85.0, kFastest_bpm = 230.0;
constexpr int kReach = 10;  // places about the likeliest that count as the same
constexpr int kNear = 4;    // within these the likeliest is looked for

double folded(double value, double period) { return value - period * std::floor(value / period); }

// The values twice over, so that a walk around them from anywhere is straight.
template <std::size_t kSize>
std::array<float, 2 * kSize + 1> twice(const std::array<float, kSize>& values) {
  std::array<float, 2 * kSize + 1> out;
  for (std::size_t i = 0; i < kSize; ++i) out[i] = out[i + kSize] = values[i];
  out[2 * kSize] = values[0];
  return out;
}

// Adds share * row, moved on by `by` places, to sum.
template <std::size_t kSize>
void add_moved(const std::array<float, kSize>& row, double by, float share,
               std::array<float, kSize>& sum) {
  const double whole = std::floor(-by);
  const auto part = static_cast<float>(-by - whole);
  const auto first = static_cast<std::size_t>(folded(whole, static_cast<double>(kSize)));
  const float here = share * (1.0f - part), next = share * part;
  const auto from = twice(row);
  for (std::size_t i = 0; i < kSize; ++i)
    sum[i] += here * from[first + i] + next * from[first + i + 1];
}

}  // namespace

StepPointer::StepPointer(const StepPattern& pattern)
    : spread_(pattern.spread), power_(pattern.power) {
  for (std::size_t s = 0; s < StepPattern::kSigns; ++s) {
    for (std::size_t i = 0; i < kPlaces; ++i)
      expected_[s][i] = pattern.value(s, static_cast<double>(i) / static_cast<double>(kPlaces));
    constant_ -= 0.5f * std::log(spread_[s] / power_[s]);
  }
}

void StepPointer::forget() {
  rates_ = 0;
  sureness_ = 0.0f;
  nothing_ = 1.0f;
}

double StepPointer::counts(MonoTime t) const {
  return counts_ + tempo_bpm_ / 60.0 * (t - middle_).as_seconds();
}

void StepPointer::add(const StepSigns::Slot& slot, double music_bpm) {
  middle_ = slot.middle;
  choose_rates(music_bpm);
  if (rates_ == 0) return;
  move(music_bpm);
  change_tempo();
  if (slot.is_seen) judge(slot);
  say();
}

void StepPointer::choose_rates(double music_bpm) {
  std::array<double, kRates> rate{};
  std::size_t rates = 0;
  for (const double factor : {0.5, 1.0, 2.0})
    if (factor * music_bpm >= kSlowest_bpm && factor * music_bpm < kFastest_bpm && rates < kRates)
      rate[rates++] = factor;
  music_bpm_ = music_bpm;
  if (rates == rates_ && rate == rate_) return;
  rate_ = rate;
  rates_ = rates;
  sureness_ = 0.0f;
  usual_ = 1.0;
  nothing_ = kNothingAtFirst;
  float sum = 0.0f;
  for (std::size_t r = 0; r < rates_; ++r) {
    const double octaves = std::log2(rate_[r] * music_bpm / kUsual_bpm) / kUsualWidth_octaves;
    for (std::size_t k = 0; k < kTempi; ++k) {
      const double off = (static_cast<double>(k) - 0.5 * (kTempi - 1)) * kTempoStep / kTempoSpread;
      Row& row = rows_[r * kTempi + k];
      row.at = 0.0;
      row.start = static_cast<float>(std::exp(-0.5 * (off * off + octaves * octaves)));
      sum += row.start;
    }
  }
  for (std::size_t k = 0; k < rates_ * kTempi; ++k) {
    rows_[k].start /= sum;
    rows_[k].belief.fill((1.0f - nothing_) * rows_[k].start / static_cast<float>(kPlaces));
  }
}

void StepPointer::move(double music_bpm) {
  constexpr double kPlacesPerCount = kPlaces / StepPattern::kCounts;
  for (std::size_t r = 0; r < rates_; ++r)
    for (std::size_t k = 0; k < kTempi; ++k) {
      const double faster = usual_ + (static_cast<double>(k) - 0.5 * (kTempi - 1)) * kTempoStep;
      Row& row = rows_[r * kTempi + k];
      row.at = folded(
          row.at + rate_[r] * music_bpm / 60.0 * faster * StepSigns::kSlot_s * kPlacesPerCount,
          kPlaces);
    }
  // Who danced may have stopped, who did not may have begun anywhere.
  float all = 0.0f;
  constexpr auto kSpreads =
      static_cast<float>(0.5 * kWander * kPlacesPerCount * kPlacesPerCount * StepSigns::kSlot_s);
  const float begun = kBegins * nothing_ / static_cast<float>(kPlaces);
  for (std::size_t k = 0; k < rates_ * kTempi; ++k) {
    const auto was = twice(rows_[k].belief);
    for (std::size_t i = 0; i < kPlaces; ++i) {
      all += was[i];
      rows_[k].belief[i] = (1.0f - kEnds) * ((1.0f - 2.0f * kSpreads) * was[i] +
                                             kSpreads * (was[i + 1] + was[i + kPlaces - 1])) +
                           begun * rows_[k].start;
    }
  }
  nothing_ += kEnds * all - kBegins * nothing_;
}

void StepPointer::change_tempo() {
  for (std::size_t k = 0; k < rates_ * kTempi; ++k) {
    moved_[k].belief = rows_[k].belief;
    for (float& p : moved_[k].belief) p *= 1.0f - 2.0f * kTempoChange;
  }
  for (std::size_t r = 0; r < rates_; ++r)
    for (std::size_t k = 0; k < kTempi; ++k) {
      const Row& from = rows_[r * kTempi + k];
      for (const int side : {-1, 1}) {
        const int to = static_cast<int>(k) + side;
        // What would leave the rows stays; less usual tempos are gone to less.
        float share = 0.0f;
        if (to >= 0 && to < static_cast<int>(kTempi)) {
          const std::size_t other = r * kTempi + static_cast<std::size_t>(to);
          share = kTempoChange * std::min(1.0f, rows_[other].start / from.start);
          add_moved(from.belief, from.at - rows_[other].at, share, moved_[other].belief);
        }
        for (std::size_t i = 0; i < kPlaces; ++i)
          moved_[r * kTempi + k].belief[i] += (kTempoChange - share) * from.belief[i];
      }
    }
  for (std::size_t k = 0; k < rates_ * kTempi; ++k) rows_[k].belief = moved_[k].belief;
}

void StepPointer::judge(const StepSigns::Slot& slot) {
  // Likelihood of each place over that of no pattern.
  Places likelihood;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    float evidence = constant_;
    for (std::size_t s = 0; s < StepPattern::kSigns; ++s) {
      const float x = slot.sign[s], off = x - expected_[s][i];
      evidence += 0.5f * (x * x / power_[s] - off * off / spread_[s]);
    }
    likelihood[i] = std::exp(std::clamp(kIndependent * evidence, -kMostEvidence, kMostEvidence));
  }
  float all = nothing_;
  const auto likely = twice(likelihood);
  for (std::size_t k = 0; k < rates_ * kTempi; ++k) {
    Row& row = rows_[k];
    const double whole = std::floor(row.at);
    const auto part = static_cast<float>(row.at - whole);
    const auto first = static_cast<std::size_t>(whole);
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const float here = likely[first + i], next = likely[first + i + 1];
      row.belief[i] *= here + part * (next - here);
      all += row.belief[i];
    }
  }
  const float scale = 1.0f / all;
  nothing_ *= scale;
  for (std::size_t k = 0; k < rates_ * kTempi; ++k)
    for (float& p : rows_[k].belief) p *= scale;
}

void StepPointer::say() {
  // Over all tempos of the likelier rate, the two halves of the eight counts folded.
  std::array<float, kRates> sum{};
  for (std::size_t k = 0; k < rates_ * kTempi; ++k)
    for (const float p : rows_[k].belief) sum[k / kTempi] += p;
  const std::size_t rate = rates_ == 2 && sum[1] > sum[0] ? 1 : 0;
  Places places{};
  double tempo = 0.0, weight = 1e-12;
  for (std::size_t k = 0; k < kTempi; ++k) {
    const Row& row = rows_[rate * kTempi + k];
    add_moved(row.belief, row.at, 1.0f, places);
    float of_row = 0.0f;
    for (const float p : row.belief) of_row += p;
    tempo += static_cast<double>(of_row) *
             (usual_ + (static_cast<double>(k) - 0.5 * (kTempi - 1)) * kTempoStep);
    weight += static_cast<double>(of_row);
  }
  std::array<float, kFold> fold;
  for (std::size_t i = 0; i < kFold; ++i) fold[i] = places[i] + places[i + kFold];
  const auto at = [&](int i) { return fold[static_cast<std::size_t>(i + 2 * kFold) % kFold]; };
  int best = 0;
  float most = -1.0f;
  for (int i = 0; i < static_cast<int>(kFold); ++i) {
    float near = 0.0f;
    for (int d = -kNear; d <= kNear; ++d) near += at(i + d);
    if (near > most) {
      most = near;
      best = i;
    }
  }
  double mass = 1e-12, moment = 0.0;
  for (int d = -kReach; d <= kReach; ++d) {
    mass += static_cast<double>(at(best + d));
    moment += d * static_cast<double>(at(best + d));
  }
  sureness_ = static_cast<float>(std::min(1.0, mass));
  counts_ =
      folded((best + moment / mass) * StepPattern::kCounts / kPlaces, StepPattern::kCounts / 2.0);
  counts_per_beat_ = rate_[rate];
  tempo_bpm_ = rate_[rate] * music_bpm_ * (tempo / weight);
  const double taken = static_cast<double>(sureness_) * StepSigns::kSlot_s / kUsualTaken_s;
  usual_ =
      std::clamp(usual_ + taken * (tempo / weight - usual_), 1.0 - kMostUsual, 1.0 + kMostUsual);
}

}  // namespace dance
