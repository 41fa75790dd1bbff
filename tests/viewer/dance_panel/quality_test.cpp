// Green, yellow and red, and why; and that it does not flicker.
#include "viewer/dance_panel/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace dance {
namespace {

const Texts kQualityTexts(Language::kEnglish);
constexpr MonoTime kQualityBegin = MonoTime::from_us(60'000'000);

QualityFigures figures_of(QualityReason reason, float value) {
  QualityFigures figures;
  switch (reason) {
    case QualityReason::kSilent:
      figures.silent_s = value;
      break;
    case QualityReason::kLoses:
      figures.loss_percent = value;
      break;
    case QualityReason::kLate:
      figures.late_ms = value;
      break;
    case QualityReason::kUneven:
      figures.jitter_ms = value;
      break;
    case QualityReason::kFew:
      figures.arrival_hz = 1000.0f / value;  // the table has the time between two
      break;
    case QualityReason::kFine:
      break;
  }
  return figures;
}

TEST(Quality, EachRowOfTheTableBeginsAtItsThresholdsAndNoEarlier) {
  std::set<QualityReason> reasons;
  for (const QualityThreshold& row : quality_thresholds()) {
    reasons.insert(row.reason);
    EXPECT_LT(row.fair, row.bad);
    EXPECT_EQ(judge(figures_of(row.reason, 0.98f * row.fair)).level, QualityLevel::kGood);
    const QualityVerdict fair = judge(figures_of(row.reason, 1.01f * row.fair));
    EXPECT_EQ(fair.level, QualityLevel::kFair);
    EXPECT_EQ(fair.reason, row.reason);
    EXPECT_EQ(judge(figures_of(row.reason, 0.98f * row.bad)).level, QualityLevel::kFair);
    EXPECT_EQ(judge(figures_of(row.reason, 1.01f * row.bad)).level, QualityLevel::kBad);
  }
  EXPECT_EQ(reasons.size(), kQualityReasons);
}

TEST(Quality, WhatIsNotKnownIsNoTrouble) {
  EXPECT_EQ(judge({}).level, QualityLevel::kGood);
  EXPECT_EQ(judge(figures_of(QualityReason::kLoses, std::nanf(""))).level, QualityLevel::kGood);
  QualityFigures none;
  none.arrival_hz = 0.0f;
  EXPECT_EQ(judge(none).level, QualityLevel::kGood) << "no poses are silence, told as such";
}

TEST(Quality, TheWorstIsTold) {
  QualityFigures figures;
  figures.loss_percent = 3.0f;
  figures.late_ms = 400.0f;
  const QualityVerdict verdict = judge(figures);
  EXPECT_EQ(verdict.level, QualityLevel::kBad);
  EXPECT_EQ(verdict.reason, QualityReason::kLate);
  figures.late_ms = 140.0f;
  EXPECT_EQ(judge(figures).reason, QualityReason::kLoses) << "of equally bad ones the first";
}

TEST(Quality, IsSaidInWords) {
  const auto said = [](const QualityFigures& figures) {
    return quality_words(judge(figures), kQualityTexts);
  };
  EXPECT_EQ(said({.loss_percent = 6.2f}), "6 % packet loss");
  EXPECT_EQ(said({.late_ms = 140.0f}), "140 ms delay");
  EXPECT_EQ(said({.late_ms = 140.0f, .is_predicted = true}), "140 ms delay, predicted");
  EXPECT_EQ(said({.silent_s = 3.4f}), "no data for 3 s");
  EXPECT_EQ(said({.jitter_ms = 33.0f}), "33 ms jitter: shown later");
  EXPECT_EQ(said({.arrival_hz = 12.0f}), "only 12 poses a second");
  EXPECT_EQ(said({}), "");
  EXPECT_EQ(said({.silent_s = 1e30f}), "no data for 99999 s");
}

TEST(QualityMeter, IsWorseAtOnceAndBetterWhenItLasts) {
  QualityMeter meter;
  QualityFigures figures;
  figures.loss_percent = 9.0f;
  EXPECT_EQ(meter.update(figures, kQualityBegin).level, QualityLevel::kBad);
  figures.loss_percent = 0.0f;
  for (int ms = 0; ms < 3000; ms += 16)
    EXPECT_EQ(meter.update(figures, kQualityBegin + Duration::ms(ms)).level, QualityLevel::kBad)
        << ms;
  EXPECT_EQ(meter.update(figures, kQualityBegin + Duration::ms(3016)).level, QualityLevel::kGood);
}

// Around a threshold, up and down with every picture.
TEST(QualityMeter, DoesNotFlicker) {
  for (const QualityThreshold& row : quality_thresholds())
    for (const float threshold : {row.fair, row.bad}) {
      QualityMeter meter;
      int changes = 0;
      QualityLevel level = QualityLevel::kGood;
      for (int i = 0; i < 60 * 60; ++i) {
        const float value = threshold * (i % 2 == 0 ? 1.1f : 0.8f);
        const auto now = kQualityBegin + Duration::ms(16 * i);
        const QualityLevel shown = meter.update(figures_of(row.reason, value), now).level;
        changes += shown != level ? 1 : 0;
        level = shown;
      }
      EXPECT_EQ(changes, 1) << static_cast<int>(row.reason) << " at " << threshold;
    }
}

TEST(QualityMeter, ItsFiguresCanBeRead) {
  QualityMeter meter;
  int changes = 0;
  float shown = -1.0f;
  for (int i = 0; i < 600; ++i) {  // ten seconds
    QualityFigures figures;
    figures.loss_percent = 20.0f + static_cast<float>(i % 11);
    const float value = meter.update(figures, kQualityBegin + Duration::ms(16 * i)).value;
    changes += value != shown ? 1 : 0;
    shown = value;
  }
  EXPECT_LE(changes, 11);
  EXPECT_GT(changes, 2);
}

}  // namespace
}  // namespace dance
