#include "transformers/tempo/period.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/beat.h"

namespace dance {
namespace {

constexpr Duration kTick = Duration::us(33'333);
constexpr double kTick_s = 1.0 / 30.0;
// A pause so long has to be bridged; a longer one is another dance.
constexpr Duration kBridged = Duration::ms(300);
constexpr Duration kAnotherDance = Duration::s(2);
// The mean that motion is against forgets as two bars of a usual tempo.
constexpr double kMean_s = 3.0;
constexpr double kVariance_s = 8.0;
// What moves less than half a centimetre counts as little as it moves.
constexpr float kLeastVariance = 2.5e-5f;
// The template forgets in so many bars; the first ones count more.
constexpr double kTemplate_bars = 8.0;
constexpr double kFirst_bars = 1.5;
// A tempo further off than this is another one, not a slip.
constexpr double kSameTempo = 0.04;
constexpr double kMusicJump_bars = 0.0625;
constexpr double kMostStep_bars = 0.02;  // of the phase, in one tick
constexpr double kTwoPi = 2.0 * std::numbers::pi;

std::complex<float> turned(double bars) {
  const double angle = kTwoPi * (bars - std::floor(bars));
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

float lerp(float a, float b, float part) { return a + part * (b - a); }

MotionFrame between(const MotionFrame& a, const MotionFrame& b, MonoTime t) {
  const double part = (t - a.time).as_seconds() / (b.time - a.time).as_seconds();
  const auto p = static_cast<float>(part);
  MotionFrame out = b;
  out.time = t;
  out.music_beats = a.music_beats + part * (b.music_beats - a.music_beats);
  for (std::size_t c = 0; c < kMotionChannels; ++c)
    out.channel[c] = lerp(a.channel[c], b.channel[c], p);
  for (std::size_t side = 0; side < 2; ++side)
    out.p_WFoot_m[side] += (1.0f - p) * (a.p_WFoot_m[side] - b.p_WFoot_m[side]);
  out.sway_m = lerp(a.sway_m, b.sway_m, p);
  return out;
}

// Hips, chest, elbows, knees and feet: what the tempo is looked for in.
constexpr std::array<std::size_t, TempoScan::kPlaces> kScanned{
    0, 1, 2, 3, 5, 6, 7, 14, 15, 16, 17, 18, 19, 26, 28, 29, 31, 32, 34};

}  // namespace

void Period::forget() {
  const double told_bpm = told_bpm_;
  const MotionChannels channels = channels_;
  *this = Period();
  told_bpm_ = told_bpm;
  channels_ = channels;
  channels_.forget();
}

double Period::tempo_bpm() const { return 60.0 * kBeatsPerBar * (bars_per_s_ + slip_); }

double Period::beats(MonoTime capture) const {
  const double since_s = (capture - tick_frame_.time).as_seconds();
  return kBeatsPerBar * (bars_ + phase_ + (bars_per_s_ + slip_) * since_s);
}

double Period::count(MonoTime capture) const {
  const double count = beats(capture) - std::arg(beat_anchor_) / kTwoPi - rest_ + 3.0;
  return count - kBeatsPerBar * std::floor(count / kBeatsPerBar);
}

void Period::observe(const Pose& pose, MonoTime /*now*/) {
  if (has_frame_) {
    const Duration since = pose.capture_time - frame_.time;
    if (pose.clock_id != clock_id_ || since > kAnotherDance || since < -Duration::s(1)) {
      forget();
    } else if (since <= Duration()) {
      return;
    }
  }
  const MotionFrame before = frame_;
  frame_ = channels_.take(pose);
  if (!has_frame_) {
    clock_id_ = pose.clock_id;
    restart(frame_);
    return;
  }
  if (frame_.time - before.time > kBridged) {
    // Nothing is known of the pause but its length.
    bars_ += (bars_per_s_ + slip_) * (frame_.time - tick_frame_.time).as_seconds();
    tick_frame_ = frame_;
    next_tick_ = frame_.time + kTick;
    motion_beats_.forget();
    return;
  }
  for (; next_tick_ <= frame_.time; next_tick_ += kTick) tick(between(before, frame_, next_tick_));
}

void Period::restart(const MotionFrame& frame) {
  has_frame_ = true;
  tick_frame_ = frame;
  mean_ = frame.channel;
  next_tick_ = frame.time + kTick;
}

void Period::tick(const MotionFrame& frame) {
  const double before_beats = tick_frame_.music_beats;
  tick_frame_ = frame;
  ++ticks_;
  // The first ticks are averaged, the later ones forget.
  const auto share = [&](double s) {
    return static_cast<float>(std::max(kTick_s / s, 1.0 / static_cast<double>(ticks_ + 1)));
  };
  const float mean_share = share(kMean_s), variance_share = share(kVariance_s);
  for (std::size_t c = 0; c < kMotionChannels; ++c) {
    mean_[c] += mean_share * (frame.channel[c] - mean_[c]);
    moved_[c] = frame.channel[c] - mean_[c];
  }
  for (std::size_t g = 0; g < kMotionGroups; ++g) {
    float sum = 0.0f;
    for (std::size_t c = kMotionGroupBegin[g]; c < kMotionGroupBegin[g + 1]; ++c)
      sum += moved_[c] * moved_[c];
    variance_[g] += variance_share * (sum - variance_[g]);
    const float gain = 1.0f / std::sqrt(variance_[g] + kLeastVariance);
    for (std::size_t c = kMotionGroupBegin[g]; c < kMotionGroupBegin[g + 1]; ++c)
      moved_[c] = std::clamp(moved_[c] * gain, -4.0f, 4.0f);
  }
  TempoScan::Sample sample;
  for (std::size_t i = 0; i < kScanned.size(); ++i) sample[i] = moved_[kScanned[i]];
  sample[TempoScan::kPlaces] = moved_[kStepChannel];
  scan_.add(sample);

  const bool had_music = has_music_;
  has_music_ = std::isfinite(frame.music_beats);
  if (has_music_) {
    const double step_bars = (frame.music_beats - before_beats) / kBeatsPerBar;
    if (had_music && std::abs(step_bars - bars_per_s_ * kTick_s) < kMusicJump_bars) {
      bars_per_s_ = std::clamp(bars_per_s_ + 0.1 * (step_bars / kTick_s - bars_per_s_), 0.0,
                               kMostTempo_bpm / 60.0 / kBeatsPerBar);
    } else {
      // Another place of the music, or the first of it.
      known_ticks_ = 0;
      phase_ = slip_ = 0.0;
      const double per_s = step_bars / kTick_s;
      bars_per_s_ = std::isfinite(per_s) && per_s > 0.0 && per_s < 2.0 ? per_s : 0.0;
    }
    bars_ = frame.music_beats / kBeatsPerBar;
  } else {
    if (had_music) known_ticks_ = 0;
    bars_ += bars_per_s_ * kTick_s;
    choose_tempo();
  }
  if (bars_per_s_ > 0.0) lock_in();
  anchor(motion_beats_.add(frame));
}

void Period::choose_tempo() {
  const double bpm = told_bpm_ > 0.0 ? told_bpm_ : scan_.tempo_bpm();
  if (!(bpm > 0.0)) return;
  const double wanted = bpm / 60.0 / kBeatsPerBar;
  if (bars_per_s_ > 0.0 && std::abs(bars_per_s_ / wanted - 1.0) < kSameTempo) return;
  bars_per_s_ = wanted;
  slip_ = 0.0;
  known_ticks_ = 0;
}

void Period::lock_in() {
  if (known_ticks_ == 0) {
    lock_ = {};
    template_ = {};
    coherence_ = 0.0f;
  }
  ++known_ticks_;
  std::array<std::array<Complex, kMotionGroups>, kHarmonics> match{};
  template_power_ = {};
  match_power_ = {};
  for (std::size_t h = 0; h < kHarmonics; ++h) {
    const Complex turn = std::conj(turned(kHarmonic[h] * bars_));
    const auto share = static_cast<float>(std::min(kHarmonic[h], 1.0) * kTick_s * bars_per_s_);
    for (std::size_t g = 0; g < kMotionGroups; ++g) {
      for (std::size_t c = kMotionGroupBegin[g]; c < kMotionGroupBegin[g + 1]; ++c) {
        Complex& z = lock_[h][c];
        z += share * (moved_[c] * turn - z);
        const Complex& t = template_[h][c];
        match[h][g] += Complex(t.real() * z.real() + t.imag() * z.imag(),
                               t.real() * z.imag() - t.imag() * z.real());
        template_power_[g] += std::norm(t);
        match_power_[g] += std::norm(z);
      }
    }
  }
  if (known_ticks_ * kTick_s * bars_per_s_ > kFirst_bars) follow(match);
  learn();
}

void Period::follow(const std::array<std::array<Complex, kMotionGroups>, kHarmonics>& match) {
  std::array<Complex, kHarmonics> sum{};
  float powers = 0.0f, template_sum = 0.0f;
  for (std::size_t g = 0; g < kMotionGroups; ++g) {
    template_sum += template_power_[g];
    powers += match_power_[g];
    for (std::size_t h = 0; h < kHarmonics; ++h) sum[h] += match[h][g];
  }
  const auto fit = [&](double phase) {
    float total = 0.0f;
    for (std::size_t h = 0; h < kHarmonics; ++h)
      total += (sum[h] * std::conj(turned(kHarmonic[h] * phase))).real();
    return total;
  };
  // One step of Newton's towards the phase that fits best: d/dφ Σ Re c_h e^(−j2πhφ) = 0.
  double slope = 0.0, bend = 0.0;
  for (std::size_t h = 0; h < kHarmonics; ++h) {
    const Complex c = sum[h] * std::conj(turned(kHarmonic[h] * phase_));
    slope += kHarmonic[h] * static_cast<double>(c.imag());
    bend += kHarmonic[h] * kHarmonic[h] * static_cast<double>(c.real());
  }
  const double size = static_cast<double>(std::sqrt(template_sum * powers)) + 1e-9;
  double step = slope / (kTwoPi * std::max(bend, 0.1 * size));
  step = std::clamp(step, -kMostStep_bars, kMostStep_bars);
  phase_ += step;
  const double share = kTick_s * bars_per_s_;
  slip_ += 0.5 * share * (step / kTick_s - slip_);
  slip_ = std::clamp(slip_, -kSameTempo * bars_per_s_, kSameTempo * bars_per_s_);
  if (!has_music_ && told_bpm_ <= 0.0) {
    const double taken = 0.25 * share * slip_;
    bars_per_s_ += taken;
    slip_ -= taken;
  }
  coherence_ = std::clamp(fit(phase_) / static_cast<float>(size), 0.0f, 1.0f);
}

void Period::learn() {
  const double bars = known_ticks_ * kTick_s * bars_per_s_;
  const bool is_first = bars <= kFirst_bars;
  const auto share =
      static_cast<float>(is_first ? 1.0 : kTick_s * bars_per_s_ / std::min(kTemplate_bars, bars));
  for (std::size_t h = 0; h < kHarmonics; ++h) {
    const Complex back = std::conj(turned(kHarmonic[h] * phase_));
    for (std::size_t c = 0; c < kMotionChannels; ++c) {
      const Complex z = lock_[h][c];
      const Complex straight(z.real() * back.real() - z.imag() * back.imag(),
                             z.real() * back.imag() + z.imag() * back.real());
      template_[h][c] += share * (straight - template_[h][c]);
    }
  }
}

void Period::anchor(std::size_t new_beats) {
  if (!is_known()) return;
  for (std::size_t i = new_beats; i-- > 0;) {
    const MotionBeat& beat = motion_beats_.newest(i);
    if (!beat.is_foot_fall()) continue;
    const double at = beats(beat.time);
    if (!std::isfinite(at)) continue;
    // About sixteen steps are remembered: two of eight counts and a half.
    constexpr double kForget = 0.94;
    beat_anchor_ *= kForget;
    for (double& steps : step_at_) steps *= kForget;
    // Feet that are only gathered are slow.
    const double swing = std::min(2.0, static_cast<double>(beat.strength));
    const double weight = (1.0 - kForget) * swing * swing;
    beat_anchor_ += weight * std::polar(1.0, kTwoPi * at);
    const double whole = std::round(at - std::arg(beat_anchor_) / kTwoPi);
    const double in_bar = whole - kBeatsPerBar * std::floor(whole / kBeatsPerBar);
    step_at_[static_cast<std::size_t>(in_bar)] += weight;
    const auto least = std::min_element(step_at_.begin(), step_at_.end());
    if (*least < 0.7 * step_at_[static_cast<std::size_t>(rest_)])
      rest_ = static_cast<int>(least - step_at_.begin());
    const double all = step_at_[0] + step_at_[1] + step_at_[2] + step_at_[3];
    anchored_ = std::abs(beat_anchor_) > 0.45 * all &&
                step_at_[static_cast<std::size_t>(rest_)] < 0.14 * all;
  }
}

}  // namespace dance
