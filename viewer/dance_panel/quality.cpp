#include "viewer/dance_panel/quality.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// Of the largest pose rate that is no trouble, as the time between two poses.
constexpr float kFair_hz = 20.0f, kBad_hz = 10.0f;
constexpr float ms_between(float hz) { return 1000.0f / hz; }

constexpr std::array<QualityThreshold, kQualityReasons> kTable{{
    {QualityReason::kSilent, 1.0f, 3.0f},                             // s
    {QualityReason::kLoses, 2.0f, 8.0f},                              // %
    {QualityReason::kLate, 120.0f, 300.0f},                           // ms
    {QualityReason::kUneven, 25.0f, 60.0f},                           // ms
    {QualityReason::kFew, ms_between(kFair_hz), ms_between(kBad_hz)}  // ms
}};
// That share of a threshold must be reached before the level goes back.
constexpr float kLeftBelow = 0.7f;

std::optional<float> measured(const QualityFigures& figures, QualityReason reason) {
  switch (reason) {
    case QualityReason::kSilent:
      return figures.silent_s;
    case QualityReason::kLoses:
      return figures.loss_percent;
    case QualityReason::kLate:
      return figures.late_ms;
    case QualityReason::kUneven:
      return figures.jitter_ms;
    case QualityReason::kFew:
      // None at all is silence.
      if (figures.arrival_hz && *figures.arrival_hz > 0.0f) return ms_between(*figures.arrival_hz);
      return std::nullopt;
    case QualityReason::kFine:
      break;
  }
  return std::nullopt;
}

QualityLevel level_of(float value, const QualityThreshold& row, const QualityVerdict& holds) {
  const auto begins = [&](float threshold, QualityLevel level) {
    const bool is_held = holds.reason == row.reason && holds.level >= level;
    return value >= threshold * (is_held ? kLeftBelow : 1.0f);
  };
  if (begins(row.bad, QualityLevel::kBad)) return QualityLevel::kBad;
  return begins(row.fair, QualityLevel::kFair) ? QualityLevel::kFair : QualityLevel::kGood;
}

std::string rounded(float value) {
  const long whole = std::lround(std::clamp(value, 0.0f, 99999.0f));
  return std::to_string(whole);
}

}  // namespace

const std::array<QualityThreshold, kQualityReasons>& quality_thresholds() { return kTable; }

QualityVerdict judge(const QualityFigures& figures, const QualityVerdict& holds) {
  QualityVerdict verdict;
  verdict.is_predicted = figures.is_predicted;
  for (const QualityThreshold& row : kTable) {
    const auto value = measured(figures, row.reason);
    if (!value || !std::isfinite(*value)) continue;
    const QualityLevel level = level_of(*value, row, holds);
    if (level <= verdict.level) continue;
    verdict.level = level;
    verdict.reason = row.reason;
    verdict.value = row.reason == QualityReason::kFew ? ms_between(*value) : *value;
  }
  return verdict;
}

const QualityVerdict& QualityMeter::update(const QualityFigures& figures, MonoTime now) {
  const QualityVerdict fresh = judge(figures, shown_);
  const auto show = [&] {
    shown_ = fresh;
    shown_at_ = now;
    other_since_ = MonoTime();
  };
  if (fresh.level > shown_.level) {
    show();
  } else if (fresh.level == shown_.level && fresh.reason == shown_.reason) {
    other_since_ = MonoTime();
    if (!shown_at_.is_set() || now - shown_at_ >= kFiguresHold) show();
  } else {
    if (!other_since_.is_set()) other_since_ = now;
    if (now - other_since_ >= kLasts) show();
  }
  return shown_;
}

std::string quality_words(const QualityVerdict& verdict, const Texts& texts) {
  const std::string value = rounded(verdict.value);
  switch (verdict.reason) {
    case QualityReason::kSilent:
      return texts.say(Text::kQualitySilent, {value});
    case QualityReason::kLoses:
      return texts.say(Text::kQualityLoses, {value});
    case QualityReason::kLate:
      return texts.say(verdict.is_predicted ? Text::kQualityLatePredicted : Text::kQualityLate,
                       {value});
    case QualityReason::kUneven:
      return texts.say(Text::kQualityUneven, {value});
    case QualityReason::kFew:
      return texts.say(Text::kQualityFew, {value});
    case QualityReason::kFine:
      break;
  }
  return {};
}

}  // namespace dance
