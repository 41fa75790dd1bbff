#include "producers/music/tracker/bar_pointer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/assert.h"

namespace dance {
namespace {

// None of these is sharp: on songs that were left out of the fit of the patterns, evidence from
// 0.06 to 0.15, floors from
// 0.25 to 0.5, stiffness from 50 to 120 and chances of a change of tempo, pattern or bar five times
//   as large moved the mean F
// by at most 0.04.
constexpr double kFastest_bpm = 214.0;
constexpr double kSlowest_bpm = 72.0;
// Of longer beats only each second number of hops is searched: it is as near, in parts of a beat.
constexpr int kCoarseFrom_hops = 56;
constexpr double kLikelyTempo_bpm = 140.0;
constexpr double kTempoSpread = 0.45;     // of its logarithm
constexpr float kEvidence = 0.1f;         // neighbouring hops are correlated
constexpr double kFloor = 0.35;           // of a law's mean: strokes that no pattern has
constexpr double kTempoStiffness = 80.0;  // from beat to beat
constexpr float kTempoJump = 2e-3f;       // probability a beat
constexpr float kPatternChange = 0.05f;   // probability a beat
constexpr float kBeatSlip = 1e-3f;        // that the bar goes on elsewhere, a beat
// To anywhere, a hop. A hundred times as much, and one verse whose drums strike on the halves turns
// a beat that was known for half a minute; a hundredth, and after a cut to another song the old
// beat stays longer.
constexpr float kForget = 1e-8f;
// A network remembers what it made its mind up by, so its answers hang together. More, and bare
// drums after a break, or half a beat late for a verse, turn the beat; less, and fast drums are
// tracked at half of their tempo.
constexpr float kMeaningEvidence = 0.05f;
constexpr double kMeaningBlur_s = 0.016;
// What a moment was is known so much later than its strengths, and stands for both hops of a step.
constexpr double kMeaningLater_s = RhythmNet::kDelay_s - OnsetStrength::kDelay_s + 0.005;

double tempo_weight(double tempo_bpm) {
  const double octaves = std::log(tempo_bpm / kLikelyTempo_bpm) / kTempoSpread;
  return std::exp(-0.5 * octaves * octaves);
}

}  // namespace

BarPointer::BarPointer(double hop_s, std::span<const MeterPattern> patterns) : hop_s_(hop_s) {
  DANCE_ASSERT(hop_s > 0.005 && hop_s < 0.02);
  choose_tempi();
  DANCE_ASSERT(!patterns.empty());
  make_states(patterns);
  make_places();
  make_tempo_changes();
}

void BarPointer::choose_tempi() {
  const auto hops = [&](double bpm) { return static_cast<int>(std::lround(60.0 / bpm / hop_s_)); };
  for (int n = hops(kFastest_bpm); n <= hops(kSlowest_bpm); n += n < kCoarseFrom_hops ? 1 : 2)
    period_hops_.push_back(n);
  tempi_ = static_cast<int>(period_hops_.size());
}

// Before anything is heard; a tempo stands for all up to the next.
double BarPointer::start_weight(int tempo) const {
  const double step = period(tempo) < kCoarseFrom_hops ? 1.0 : 2.0;
  return step * tempo_weight(60.0 / (period(tempo) * hop_s_));
}

void BarPointer::make_states(std::span<const MeterPattern> patterns) {
  patterns_ = patterns.size();
  int states = 0;
  for (std::size_t p = 0; p < patterns_; ++p)
    for (int tempo = 0; tempo < tempi_; ++tempo) {
      const double tempo_bpm = 60.0 / (period(tempo) * hop_s_);
      if (tempo_bpm < patterns[p].least_tempo_bpm || tempo_bpm > patterns[p].most_tempo_bpm)
        continue;
      blocks_.push_back({p, tempo, states, 0.0f});
      states += static_cast<int>(kPatternBeats) * period(tempo);
    }
  for (Eigen::ArrayXf* array : {&state_, &constant_}) *array = Eigen::ArrayXf::Zero(states);
  for (Eigen::ArrayXf& slope : slope_) slope = Eigen::ArrayXf::Zero(states);
  float sum = 0.0f;
  for (Block& block : blocks_) {
    describe(patterns[block.pattern], block);
    const int n = static_cast<int>(kPatternBeats) * period(block.tempo);
    block.start = static_cast<float>(start_weight(block.tempo));
    sum += block.start * static_cast<float>(n);
  }
  for (Block& block : blocks_) {
    block.start /= sum;
    state_.segment(block.first, static_cast<int>(kPatternBeats) * period(block.tempo)) =
        block.start;
  }
  const auto columns = static_cast<Eigen::Index>(patterns_ * kPatternBeats);
  ending_ = Eigen::MatrixXf::Zero(tempi_, columns);
  entering_ = Eigen::MatrixXf::Zero(tempi_, columns);
  total_ = Eigen::VectorXf::Zero(tempi_);
}

void BarPointer::make_places() {
  int places = 0;
  for (int tempo = 0; tempo < tempi_; ++tempo) {
    beat_first_.push_back(places);
    bar_first_.push_back(static_cast<int>(kPatternBeats) * places);
    places += period(tempo);
  }
  beat_ = Eigen::ArrayXf::Zero(places);
  for (Eigen::ArrayXf* array : {&on_beat_, &on_half_, &meant_})
    *array = Eigen::ArrayXf::Zero(static_cast<int>(kPatternBeats) * places);
  for (int tempo = 0; tempo < tempi_; ++tempo)
    for (int i = 0; i < static_cast<int>(kPatternBeats) * period(tempo); ++i) {
      const double beat = period(tempo);
      const auto near = [&](double place_beats) {
        const double away =
            std::remainder(i - kMeaningLater_s / hop_s_ - place_beats * beat, beat) * hop_s_ /
            kMeaningBlur_s;
        return kMeaningEvidence * static_cast<float>(std::exp(-0.5 * away * away));
      };
      on_beat_[bar_first_[static_cast<std::size_t>(tempo)] + i] = near(0.0);
      on_half_[bar_first_[static_cast<std::size_t>(tempo)] + i] = near(0.5);
    }
}

// The mean m of a group's strength at each place of a bar; the law is (1/m) exp(-y/m), its
// logarithm times kEvidence.
void BarPointer::describe(const MeterPattern& pattern, const Block& block) {
  const int beat = period(block.tempo);
  const int n = static_cast<int>(kPatternBeats) * beat;
  Eigen::ArrayXd mean(n);
  for (std::size_t g = 0; g < kOnsetGroups; ++g) {
    mean.setZero();
    for (std::size_t slot = 0; slot < kPatternSlots; ++slot) {
      const std::size_t places = kPatternPlaces_beats.size();
      const double at_beats =
          static_cast<double>(slot / places) + kPatternPlaces_beats[slot % places];
      const double centre = at_beats * beat + kLater_s[g] / hop_s_;
      for (int i = 0; i < n; ++i) {
        const double away =
            std::remainder(i - centre, static_cast<double>(n)) * hop_s_ / kBlur_s[g];
        mean[i] += pattern.weights[g][slot] * std::exp(-0.5 * away * away);
      }
    }
    mean = kFloor + (1.0 - kFloor) * mean / std::max(mean.mean(), 1e-9);
    constant_.segment(block.first, n) -= kEvidence * mean.log().cast<float>();
    slope_[g].segment(block.first, n) = kEvidence / mean.cast<float>();
  }
}

void BarPointer::make_tempo_changes() {
  Eigen::VectorXf anywhere(tempi_);
  for (int i = 0; i < tempi_; ++i) anywhere[i] = static_cast<float>(start_weight(i));
  anywhere /= anywhere.sum();
  tempo_change_.resize(tempi_, tempi_);
  for (int from = 0; from < tempi_; ++from) {
    for (int to = 0; to < tempi_; ++to) {
      const double ratio = static_cast<double>(period(to)) / period(from);
      tempo_change_(to, from) =
          static_cast<float>(std::exp(-kTempoStiffness * std::abs(ratio - 1.0)));
    }
    tempo_change_.col(from) *= (1.0f - kTempoJump) / tempo_change_.col(from).sum();
    tempo_change_.col(from) += kTempoJump * anywhere;
  }
}

// Within a beat nothing can change; at its end tempo, pattern and the beat of the bar can.
void BarPointer::gather_beat_ends() {
  constexpr auto kBeats = static_cast<Eigen::Index>(kPatternBeats);
  ending_.setZero();
  for (const Block& block : blocks_) {
    const int n = period(block.tempo);
    for (Eigen::Index beat = 0; beat < kBeats; ++beat) {
      const auto before = static_cast<int>((beat + kBeats - 1) % kBeats);
      ending_(block.tempo, static_cast<Eigen::Index>(block.pattern) * kBeats + beat) =
          state_[block.first + (before + 1) * n - 1];
    }
  }
  const auto patterns = static_cast<Eigen::Index>(patterns_);
  for (Eigen::Index beat = 0; beat < kBeats; ++beat) {
    total_.setZero();
    for (Eigen::Index p = 0; p < patterns; ++p) total_ += ending_.col(p * kBeats + beat);
    total_ *= kPatternChange / static_cast<float>(patterns_);
    for (Eigen::Index p = 0; p < patterns; ++p)
      ending_.col(p * kBeats + beat) =
          (1.0f - kPatternChange) * ending_.col(p * kBeats + beat) + total_;
  }
  for (Eigen::Index p = 0; p < patterns; ++p) {
    total_ = ending_.middleCols(p * kBeats, kBeats).rowwise().sum() *
             (kBeatSlip / static_cast<float>(kBeats));
    ending_.middleCols(p * kBeats, kBeats) *= 1.0f - kBeatSlip;
    ending_.middleCols(p * kBeats, kBeats).colwise() += total_;
  }
  for (Eigen::Index c = 0; c < ending_.cols(); ++c)
    entering_.col(c).noalias() = tempo_change_.lazyProduct(ending_.col(c));
}

// Block by block, so that a block's numbers are still near when they are needed again.
void BarPointer::push(const OnsetStrength::Strengths& strengths, const StrokeMeaning& meaning,
                      float weight, std::span<const float> of_periods) {
  DANCE_ASSERT(static_cast<int>(of_periods.size()) == most_period_hops() - least_period_hops() + 1);
  gather_beat_ends();
  std::array<float, kOnsetGroups> y{};
  for (std::size_t g = 0; g < kOnsetGroups; ++g) y[g] = std::min(strengths[g], kMostStrength);
  meant_ = meaning.beat * on_beat_ + meaning.half * on_half_;
  static_assert(kOnsetGroups == 5);
  constexpr auto kBeats = static_cast<int>(kPatternBeats);
  float sum = 0.0f;
  for (const Block& block : blocks_) {
    const int n = period(block.tempo);
    const int all = n * kBeats;
    float* states = state_.data() + block.first;
    std::memmove(states + 1, states, static_cast<std::size_t>(all - 1) * sizeof(float));
    for (int beat = 0; beat < kBeats; ++beat)
      states[beat * n] =
          entering_(block.tempo, static_cast<Eigen::Index>(block.pattern) * kBeats + beat);
    const auto part = [&](const Eigen::ArrayXf& of) { return of.segment(block.first, all); };
    auto state = state_.segment(block.first, all);
    const float of_period = of_periods[static_cast<std::size_t>(n - least_period_hops())];
    state *= (of_period +
              weight * (part(constant_) - y[0] * part(slope_[0]) - y[1] * part(slope_[1]) -
                        y[2] * part(slope_[2]) - y[3] * part(slope_[3]) - y[4] * part(slope_[4]) +
                        meant_.segment(bar_first_[static_cast<std::size_t>(block.tempo)], all)))
                 .exp();
    sum += state.sum();
  }
  const float scale = 1.0f / sum;
  beat_.setZero();
  for (const Block& block : blocks_) {
    const int n = period(block.tempo);
    auto state = state_.segment(block.first, n * kBeats);
    state = state * scale + kForget * block.start;
    auto places = beat_.segment(beat_first_[static_cast<std::size_t>(block.tempo)], n);
    for (int beat = 0; beat < kBeats; ++beat) places += state_.segment(block.first + beat * n, n);
  }
}

BarPointer::Place BarPointer::likeliest() const {
  Eigen::Index best = 0;
  beat_.maxCoeff(&best);
  const auto above =
      std::upper_bound(beat_first_.begin(), beat_first_.end(), static_cast<int>(best));
  const auto tempo = static_cast<int>(above - beat_first_.begin()) - 1;
  const int n = period(tempo);
  const int place = static_cast<int>(best) - beat_first_[static_cast<std::size_t>(tempo)];
  return near(n, n - place);
}

BarPointer::Place BarPointer::near(double period_hops, double to_beat_hops) const {
  constexpr double kTempoReach = 0.07;
  constexpr double kPhaseReach = 0.16;
  double probability = 0.0;
  double periods = 0.0;
  double away = 0.0;
  for (int tempo = 0; tempo < tempi_; ++tempo) {
    const int n = period(tempo);
    if (std::abs(n / period_hops - 1.0) > kTempoReach) continue;
    const float* places = beat_.data() + beat_first_[static_cast<std::size_t>(tempo)];
    for (int i = 0; i < n; ++i) {
      const double d = std::remainder(n - i - to_beat_hops, static_cast<double>(n));
      if (std::abs(d) > kPhaseReach * n) continue;
      const double p = places[i];
      probability += p;
      periods += p * n;
      away += p * d;
    }
  }
  if (probability < 1e-12) return {period_hops, to_beat_hops, 0.0};
  return {periods / probability, to_beat_hops + away / probability, probability};
}

}  // namespace dance
