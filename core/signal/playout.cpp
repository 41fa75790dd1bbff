#include "core/signal/playout.h"

#include <cmath>
#include <cstdio>

namespace dance {
namespace {

bool is_figure(float value, float most) { return std::isnan(value) || std::abs(value) <= most; }

std::string figure(float value, const char* unit) {
  if (std::isnan(value)) return std::string("? ") + unit;
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %s", static_cast<double>(value), unit);
  return text;
}

std::string where_text(const Playout& playout) {
  if (std::isnan(playout.beats)) return figure(playout.delay_ms, "ms late");
  if (std::abs(playout.beats) < 0.05f) return "now";
  char text[48];
  std::snprintf(text, sizeof text, "%.1f", static_cast<double>(playout.beats));
  std::string beats(text);
  if (beats.ends_with(".0")) beats.resize(beats.size() - 2);
  return beats + (beats == "1" ? " beat behind" : " beats behind");
}

std::string predictions_text(const Playout& playout) {
  return "predictions as far ahead as poses are late are " + figure(playout.error_mm, "mm off") +
         ", " + figure(playout.limit_mm, "are allowed");
}

}  // namespace

bool is_valid(const Playout& p) {
  return static_cast<std::size_t>(p.reason) < kPlayoutReasons && is_figure(p.beats, 1e3f) &&
         is_figure(p.delay_ms, 1e7f) && is_figure(p.ahead_ms, 1e7f) &&
         is_figure(p.error_mm, 1e6f) && is_figure(p.limit_mm, 1e6f) && p.partner_share >= 0.0f &&
         p.partner_share <= 1.0f;
}

std::string playout_text(const Playout& playout) {
  std::string text = where_text(playout);
  switch (playout.reason) {
    case PlayoutReason::kNoRhythm:
      break;
    case PlayoutReason::kMusicMissing:
      text += ": no music is heard here";
      break;
    case PlayoutReason::kBeatUnknown:
      text += ": the dancer's beat is not known";
      break;
    case PlayoutReason::kAsked:
      text += ", as asked";
      break;
    case PlayoutReason::kGoodEnough:
    case PlayoutReason::kTooFar:
      text += ": " + predictions_text(playout);
      break;
    case PlayoutReason::kNotMeasured:
      text += ": predictions of this dancer are not measured yet";
      break;
  }
  if (playout.partner.is_set()) text += "; beside " + std::string(playout.partner.view());
  return text;
}

}  // namespace dance
