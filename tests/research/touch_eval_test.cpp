// `dance touch eval` on synthetic couples: that it counts what it says, and that what it calls
// chance and chosen on others is.
#include "research/touch/touch_eval.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "producers/salsa/salsa_dancer.h"
#include "research/touch/touch_spread.h"

namespace dance {
namespace {

CoupleTake salsa_couple(std::uint64_t seed, int seconds) {
  CoupleTake couple;
  for (std::size_t d = 0; d < 2; ++d) {
    SalsaStyle style;
    style.role = d == 0 ? SalsaRole::kLead : SalsaRole::kFollow;
    style.seed = seed;
    SalsaDancer dancer(style);
    couple[d].name = d == 0 ? "lead" : "follow";
    couple[d].skeleton = dancer.skeleton();
    for (int i = 0; i < 60 * seconds; ++i) {
      const Duration t = Duration::us(i * 1'000'000LL / 60);
      Pose pose;
      dancer.dance_at(t, pose);
      pose.sequence = static_cast<std::uint32_t>(i);
      pose.clock_id = 1;
      pose.capture_time = MonoTime::from_us(1'000'000) + t;
      couple[d].poses.push_back(pose);
    }
  }
  return couple;
}

const TouchRow& row_named(const TouchEval& eval, const std::string& stage, const std::string& way) {
  for (const TouchRow& row : eval.rows)
    if (row.stage == stage && row.way == way) return row;
  ADD_FAILURE() << stage << ", " << way;
  return eval.rows.front();
}

TEST(TouchEval, CountsFoundFalseFarAndBrokenHoldsPairByPair) {
  HoldCount count;
  const auto add = [&](bool reported, float danced_m) {
    count.add({reported, false, false, false}, {danced_m, 1.0f, 1.0f, 1.0f});
  };
  add(false, 0.05f);  // missed
  add(true, 0.05f);
  add(true, 0.2f);  // apart
  add(true, 0.05f);
  add(false, 0.05f);  // broken
  add(true, 0.1f);    // false, as the recording is not within 8 cm
  add(false, 0.3f);
  add(true, 0.3f);  // false and far, to the end
  const HoldFigures figures = count.figures(30.0);
  EXPECT_EQ(figures.true_frames, 4u);
  EXPECT_EQ(figures.found_frames, 2u);
  EXPECT_EQ(figures.apart_frames, 2u);
  EXPECT_EQ(figures.holds, 3u);
  EXPECT_EQ(figures.false_holds, 2u);
  EXPECT_EQ(figures.far_holds, 1u);
  EXPECT_EQ(figures.breaks, 1u);
  EXPECT_EQ(figures.true_holds, 2u);
  EXPECT_DOUBLE_EQ(figures.found(), 0.5);
  EXPECT_DOUBLE_EQ(figures.per_minute(figures.false_holds), 4.0);
}

TEST(TouchEval, JudgesASyntheticCoupleOnAllStages) {
  const TouchEval eval = evaluate_touch({salsa_couple(1, 20)}, {});
  const HoldFigures captured = row_named(eval, "as captured", "holds").figures;
  EXPECT_NEAR(captured.seconds, 16.0, 0.1);
  ASSERT_GT(captured.true_frames, 500u) << "this couple does not hold hands";
  EXPECT_GT(captured.found(), 0.99);
  EXPECT_EQ(row_named(eval, "as captured", "within 8 cm").figures.found(), 1.0);
  // Through a line less is found, and by holds more of it than by a threshold.
  const HoldFigures near = row_named(eval, "on the stage", "within 8 cm").figures;
  const HoldFigures holds = row_named(eval, "on the stage", "holds").figures;
  EXPECT_LT(near.found(), 1.0);
  EXPECT_GE(holds.found(), near.found());
  EXPECT_LE(holds.breaks, near.breaks);
  const std::string table = touch_eval_table(eval);
  EXPECT_NE(table.find("0.3 minutes"), std::string::npos) << table;
}

TEST(TouchEval, ASeedIsADrawOfTheLineAndTheSameSeedTheSameDraw) {
  const std::vector<CoupleTake> couples{salsa_couple(2, 9)};
  SpreadWish wish;
  wish.delays = {Duration::ms(60), Duration::ms(120)};
  wish.seeds = 2;
  const TouchSpread spread = evaluate_spread(couples, {}, wish);
  ASSERT_EQ(spread.rows.size(), 4u);  // of each delay the threshold and the holds
  const TouchSpread again = evaluate_spread(couples, {}, wish);
  TouchLine next;
  next.seed = 1;
  wish.seeds = 1;
  const TouchSpread second = evaluate_spread(couples, next, wish);
  bool differs = false;
  for (std::size_t r = 0; r < 4; ++r) {
    const auto& seeds = spread.rows[r].figures;
    ASSERT_EQ(seeds.size(), 2u);
    for (std::size_t s = 0; s < 2; ++s)
      EXPECT_EQ(seeds[s].held_frames, again.rows[r].figures[s].held_frames);
    EXPECT_EQ(seeds[1].held_frames, second.rows[r].figures[0].held_frames);
    differs = differs || seeds[0].held_frames != seeds[1].held_frames;
  }
  EXPECT_TRUE(differs);
  // At seed 0 it is what the table without seeds says.
  const HoldFigures one = row_named(evaluate_touch(couples, {}), "on the stage", "holds").figures;
  EXPECT_EQ(spread.rows[1].figures[0].held_frames, one.held_frames);
  EXPECT_EQ(spread.rows[1].figures[0].false_holds, one.false_holds);
}

TEST(TouchEval, LimitsOfADanceAreChosenOnTheOthersAlone) {
  SpreadWish wish;
  wish.delays = {Duration::ms(120)};
  wish.seeds = 1;
  wish.chooses = true;
  const auto chosen = [&](std::uint64_t first, std::uint64_t second) {
    const TouchSpread spread =
        evaluate_spread({salsa_couple(first, 6), salsa_couple(second, 6)}, {}, wish);
    EXPECT_EQ(spread.rows.size(), 3u);
    EXPECT_EQ(spread.chosen.size(), 2u);
    const auto report = nlohmann::json::parse(touch_spread_json(spread));
    EXPECT_EQ(report["chosen"].size(), 2u);
    for (std::size_t dance = 0; dance < 2; ++dance) {
      const PalmHold::Limits& limits = spread.chosen.at(dance);
      const auto& said = report["chosen"].at(dance);
      EXPECT_FLOAT_EQ(said["begin_m"].get<float>(), limits.begin_m);
      EXPECT_FLOAT_EQ(said["soon_m"].get<float>(), limits.soon_m);
      EXPECT_EQ(said["release_ms"], limits.release_delay.count_ms());
    }
    return std::array{spread.chosen.at(0).begin_m, spread.chosen.at(0).early_m,
                      spread.chosen.at(0).end_m};
  };
  // Another first dance changes nothing of what is chosen for it.
  EXPECT_EQ(chosen(3, 4), chosen(5, 4));
}

}  // namespace
}  // namespace dance
