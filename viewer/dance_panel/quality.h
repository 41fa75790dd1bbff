// How well a guest's dance comes over, in one glance: green, yellow or red, and why. All thresholds
// stand in one table (quality.cpp).
//
// Units/frames: as the fields say; MonoTime of the house's clock.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      figures that are not known count for nothing.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/base/time.h"
#include "viewer/words/texts.h"

namespace dance {

enum class QualityLevel : std::uint8_t { kGood, kFair, kBad };

// The most urgent first: of equally bad ones the first is told.
enum class QualityReason : std::uint8_t { kSilent, kLoses, kLate, kUneven, kFew, kFine };
constexpr std::size_t kQualityReasons = 5;

struct QualityFigures {
  std::optional<float> silent_s{};      // since the newest pose
  std::optional<float> loss_percent{};  // of the last seconds
  std::optional<float> late_ms{};       // delay of the network and its server
  std::optional<float> jitter_ms{};
  std::optional<float> arrival_hz{};
  bool is_predicted = false;  // the stage shows a moment that has not arrived
};

struct QualityVerdict {
  QualityLevel level = QualityLevel::kGood;
  QualityReason reason = QualityReason::kFine;
  float value = 0.0f;  // s, %, ms, ms or poses a second
  bool is_predicted = false;
};

// What a row of the table says: at `fair` yellow begins, at `bad` red.
struct QualityThreshold {
  QualityReason reason;
  float fair;
  float bad;
};
const std::array<QualityThreshold, kQualityReasons>& quality_thresholds();

// A level that holds is left only well below its threshold.
QualityVerdict judge(const QualityFigures& figures, const QualityVerdict& holds = {});

// Worse is shown at once, better only when it lasts.
class QualityMeter {
 public:
  static constexpr Duration kLasts = Duration::s(3);
  static constexpr Duration kFiguresHold = Duration::s(1);  // else they cannot be read

  const QualityVerdict& update(const QualityFigures& figures, MonoTime now);
  const QualityVerdict& shown() const { return shown_; }

 private:
  QualityVerdict shown_;
  MonoTime shown_at_;
  MonoTime other_since_;  // not set: what is measured is what is shown
};

// Below the guest's name: "6 % packet loss"; "" where it is good.
std::string quality_words(const QualityVerdict& verdict, const Texts& texts);

}  // namespace dance
