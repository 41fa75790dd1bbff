#include "producers/salsa/salsa_score.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "core/pose/skeleton.h"
#include "tests/producers/salsa/salsa_couple.h"

namespace dance {
namespace {

SalsaCounts counts_of(const SalsaScore& score, SalsaRole role, double beats) {
  SalsaCounts counts;
  score.counts_around(role, beats, counts);
  return counts;
}

TEST(SalsaStyle, OfTheDefaultsIsFine) { EXPECT_TRUE(checked_style(SalsaStyle{}).has_value()); }

TEST(SalsaStyle, RefusesATempoThatNobodyDancesAndNamesIt) {
  for (const double tempo : {0.0, 59.9, 240.1, -184.0, 1e300}) {
    const auto checked = checked_style(salsa_style(1, tempo));
    ASSERT_FALSE(checked.has_value()) << tempo;
    EXPECT_NE(checked.error().what.find("tempo"), std::string::npos) << checked.error().what;
    EXPECT_NE(checked.error().what.find("60 to 240"), std::string::npos) << checked.error().what;
  }
  EXPECT_NE(checked_style(salsa_style(1, 12.5)).error().what.find("12.5"), std::string::npos);
}

TEST(SalsaStyle, RefusesWhatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double SalsaStyle::*const value :
       {&SalsaStyle::tempo_bpm, &SalsaStyle::start_beat, &SalsaStyle::energy, &SalsaStyle::x_m,
        &SalsaStyle::z_m, &SalsaStyle::heading_deg}) {
    SalsaStyle style;
    style.*value = nan;
    EXPECT_FALSE(checked_style(style).has_value());
  }
}

TEST(SalsaSkeleton, HasTheLeadTallerAndBothStandOnTheFloor) {
  std::set<float> heights;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Skeleton lead = salsa_skeleton(SalsaRole::kLead, seed);
    const Skeleton follow = salsa_skeleton(SalsaRole::kFollow, seed);
    EXPECT_NEAR(standing_height_m(lead), 1.78f, 0.05f);
    EXPECT_NEAR(standing_height_m(follow), 1.66f, 0.05f);
    EXPECT_GT(standing_height_m(lead), standing_height_m(follow));
    for (const Skeleton& body : {lead, follow}) {
      EXPECT_TRUE(is_valid(body));
      BodyFrames frames;
      Pose standing;
      standing.p_WH_m = {0.0f, body.hips_height_m(), 0.0f};
      forward_kinematics(body, standing, frames);
      EXPECT_NEAR(frames.tip(Tip::kLeftToes).y(), 0.0f, 1e-5f);
      EXPECT_NEAR(frames.tip(Tip::kRightToes).y(), 0.0f, 1e-5f);
    }
    EXPECT_EQ(lead, salsa_skeleton(SalsaRole::kLead, seed));
    heights.insert(standing_height_m(lead));
  }
  EXPECT_GT(heights.size(), 40u) << "bodies differ from seed to seed";
}

TEST(SalsaScore, BringsEverybodyHomeWithinEachChorus) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const SalsaScore score(salsa_style(seed));
    for (std::int64_t chorus = -4; chorus < 20; ++chorus) {
      int changes = 0;
      for (std::int64_t eight = 8 * chorus; eight < 8 * chorus + 8; ++eight)
        changes += score.figure(eight) == SalsaFigure::kCrossBodyLead;
      EXPECT_EQ(changes, 2) << "seed " << seed << " chorus " << chorus;
      EXPECT_EQ(score.figure(8 * chorus), SalsaFigure::kBasic);
    }
  }
}

TEST(SalsaScore, DancesEveryFigureAndNotTwiceTheSameChorus) {
  std::set<SalsaFigure> figures;
  std::set<std::vector<SalsaFigure>> choruses;
  const SalsaScore score(salsa_style(7));
  for (std::int64_t chorus = 0; chorus < 12; ++chorus) {
    std::vector<SalsaFigure> order;
    for (std::int64_t eight = 8 * chorus; eight < 8 * chorus + 8; ++eight)
      order.push_back(score.figure(eight));
    figures.insert(order.begin(), order.end());
    choruses.insert(order);
  }
  EXPECT_EQ(figures.size(), 5u);
  EXPECT_GT(choruses.size(), 9u);
}

TEST(SalsaScore, StepsOnSixOfEightCountsLeftAndRightInTurn) {
  const SalsaScore score(salsa_style(3));
  for (int beat = -24; beat < 200; ++beat) {
    const SalsaCounts counts = counts_of(score, SalsaRole::kLead, beat);
    const int count = ((beat % 8) + 8) % 8 + 1;
    const bool is_pause = count == 4 || count == 8;
    EXPECT_EQ(counts.at(beat).is_step, !is_pause) << "count " << count;
    EXPECT_EQ(counts.at(beat).is_left, count == 1 || count == 3 || count == 4 || count == 6)
        << "count " << count;
  }
}

TEST(SalsaScore, HasLeadAndFollowStepOnOppositeFeet) {
  const SalsaScore score(salsa_style(5));
  for (int beat = 0; beat < 256; ++beat) {
    const SalsaCounts lead = counts_of(score, SalsaRole::kLead, beat);
    const SalsaCounts follow = counts_of(score, SalsaRole::kFollow, beat);
    EXPECT_EQ(lead.at(beat).is_step, follow.at(beat).is_step);
    EXPECT_NE(lead.at(beat).is_left, follow.at(beat).is_left);
  }
}

TEST(SalsaScore, GivesACountTheSamePlaceFromWhereverItIsAsked) {
  const SalsaScore score(salsa_style(11));
  for (int beat = 0; beat < 128; ++beat) {
    const SalsaCounts here = counts_of(score, SalsaRole::kFollow, beat);
    const SalsaCounts later = counts_of(score, SalsaRole::kFollow, beat + 5.5);
    const SalsaCount& a = here.at(beat);
    const SalsaCount& b = later.at(beat);
    EXPECT_EQ(a.foot.x_m, b.foot.x_m);
    EXPECT_EQ(a.foot.z_m, b.foot.z_m);
    EXPECT_NEAR(std::remainder(a.foot.yaw_rad - b.foot.yaw_rad, 2 * 3.14159265358979), 0.0, 1e-9);
    EXPECT_EQ(a.sway, b.sway);
  }
}

TEST(SalsaScore, ShareOfHoldsAlwaysAddsUpToOne) {
  const SalsaScore score(salsa_style(13));
  for (int beat = 0; beat < 512; ++beat) {
    const SalsaHold hold = counts_of(score, SalsaRole::kLead, beat).at(beat).hold;
    EXPECT_NEAR(hold.low + hold.side + hold.over, 1.0, 1e-12) << beat;
    EXPECT_NEAR(hold.joined + hold.embrace + hold.free, 1.0, 1e-12) << beat;
  }
}

}  // namespace
}  // namespace dance
