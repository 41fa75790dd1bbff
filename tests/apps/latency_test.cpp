// The journey's arithmetic: which step took how long, what is compared with whose clock, and what
// is said of it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/latency/latency_report.h"

namespace dance {
namespace {

constexpr std::uint64_t kOurs = 7;
constexpr std::uint64_t kOther = 8;

GuestId guest(const char* name) { return *GuestId::parse(name); }
MonoTime at_us(std::int64_t us) { return MonoTime::from_us(1'000'000 + us); }

// Captured at 0; each hop after the one before: published 10, link sent 110, server 310, link
// received 610, stage taken 1010, staged 1510 µs.
Pose travelled() {
  Pose pose;
  pose.clock_id = kOurs;
  pose.capture_time = at_us(0);
  const std::int64_t hops_us[kHopCount] = {10, 110, 310, 610, 1010, 1510};
  for (std::size_t i = 0; i < kHopCount; ++i) pose.hops[i] = at_us(hops_us[i]);
  return pose;
}

const GuestJourney::Row* find_row(const std::vector<GuestJourney::Row>& rows, Step from, Step to) {
  for (const auto& row : rows)
    if (row.from == from && row.to == to) return &row;
  return nullptr;
}

void expect_about(const Histogram* histogram, std::int64_t us) {
  ASSERT_NE(histogram, nullptr);
  EXPECT_NEAR(static_cast<double>(histogram->percentile(0.5).count_us()), static_cast<double>(us),
              1.0 + 0.022 * static_cast<double>(us));
}

TEST(GuestJourney, TimesEachStepAndTheWholeWay) {
  GuestJourney journey(guest("bob"));
  for (int i = 0; i < 10; ++i) journey.heard(travelled(), at_us(2110), kOurs);
  const auto rows = journey.rows();
  ASSERT_EQ(rows.size(), 7u);
  const std::int64_t steps_us[] = {10, 100, 200, 300, 400, 500, 600};
  const std::int64_t since_us[] = {10, 110, 310, 610, 1010, 1510, 2110};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(rows[i].to), i + 1);
    expect_about(rows[i].took, steps_us[i]);
    expect_about(rows[i].since_capture, since_us[i]);
    EXPECT_EQ(rows[i].took->count(), 10u);
  }
  EXPECT_FALSE(journey.has_passed(Step::kShown));
}

TEST(GuestJourney, StepsThatWereNotPassedAreBridged) {
  Pose pose = travelled();
  for (const Hop hop : {Hop::kLinkSent, Hop::kServer, Hop::kLinkReceived}) pose.stamp(hop, {});
  GuestJourney journey(guest("alice"));
  journey.heard(pose, at_us(2110), kOurs);
  const auto rows = journey.rows();
  EXPECT_EQ(rows.size(), 4u);
  const auto* bridge = find_row(rows, Step::kPublished, Step::kStageTaken);
  ASSERT_NE(bridge, nullptr);
  expect_about(bridge->took, 1000);
  EXPECT_FALSE(journey.has_passed(Step::kServer));
  EXPECT_NE(journey_table(journey).find("(since published)"), std::string::npos);
  EXPECT_NE(journey_table(journey).find("not passed: link sent, server, link received, shown"),
            std::string::npos);
}

TEST(GuestJourney, AnotherClocksStampsAreNotComparedWithOurs) {
  Pose pose = travelled();
  pose.clock_id = kOther;
  GuestJourney journey(guest("bob"));
  journey.heard(pose, at_us(-999'000), kOurs);
  EXPECT_FALSE(journey.has_passed(Step::kHeard));
  EXPECT_TRUE(journey.has_passed(Step::kStaged));
  EXPECT_EQ(journey.of_another_clock(), 1u);
  EXPECT_EQ(journey.backwards(), 0u);
}

TEST(GuestJourney, StampsWithoutAClockAreComparedWithNothing) {
  Pose pose = travelled();
  pose.clock_id = 0;
  GuestJourney journey(guest("bob"));
  journey.heard(pose, at_us(2110), kOurs);
  EXPECT_TRUE(journey.rows().empty());
  EXPECT_EQ(journey.without_clock(), 1u);
  EXPECT_NE(journey_table(journey).find("say no clock"), std::string::npos);
}

TEST(GuestJourney, StampsThatRunBackwardsAreCountedAndLeftOut) {
  Pose pose = travelled();
  pose.stamp(Hop::kServer, at_us(50));  // before it was sent
  GuestJourney journey(guest("bob"));
  journey.heard(pose, at_us(2110), kOurs);
  EXPECT_EQ(journey.backwards(), 1u);
  EXPECT_NE(journey_table(journey).find("1 times a step ended before it began and is left out"),
            std::string::npos);
  EXPECT_EQ(find_row(journey.rows(), Step::kLinkSent, Step::kServer), nullptr);
  EXPECT_NE(find_row(journey.rows(), Step::kServer, Step::kLinkReceived), nullptr);
}

TEST(GuestJourney, ADisplaysOwnTimesReplaceOurs) {
  GuestJourney journey(guest("bob"));
  journey.heard(travelled(), at_us(9000), kOurs);
  StageTime time;
  time.clock_id = kOurs;
  time.capture_time = at_us(0);
  time.hops = travelled().hops;
  time.heard_time = at_us(1710);
  time.swap_time = at_us(9710);
  journey.shown(time);
  const auto rows = journey.rows();
  const auto* heard = find_row(rows, Step::kStaged, Step::kHeard);
  const auto* shown = find_row(rows, Step::kHeard, Step::kShown);
  ASSERT_NE(heard, nullptr);
  ASSERT_NE(shown, nullptr);
  expect_about(heard->took, 200);
  expect_about(shown->took, 8000);
  expect_about(shown->since_capture, 9710);
}

TEST(GuestJourney, AGuestDrawnStraightFromCaptureHasAJourneyToo) {
  StageTime time;
  time.clock_id = kOurs;
  time.capture_time = at_us(0);
  time.hops[0] = at_us(10);
  time.heard_time = at_us(210);
  time.swap_time = at_us(5210);
  GuestJourney journey(guest("alice"));
  journey.shown(time);
  const auto rows = journey.rows();
  ASSERT_EQ(rows.size(), 3u);
  expect_about(find_row(rows, Step::kPublished, Step::kHeard)->took, 200);
}

TEST(Journeys, AreBoundedWhateverNamesAreSent) {
  Journeys journeys;
  for (int i = 0; i < 1000; ++i)
    if (GuestJourney* journey = journeys.of(guest(("g" + std::to_string(i)).c_str())))
      journey->heard(travelled(), at_us(2110), kOurs);
  EXPECT_EQ(journeys.all().size(), Journeys::kMaxJourneyGuests);
  EXPECT_EQ(journeys.refused(), 1000 - Journeys::kMaxJourneyGuests);
}

TEST(LatencyReport, JsonHoldsWhatTheTableShows) {
  Journeys journeys;
  journeys.of(guest("bob"))->heard(travelled(), at_us(2110), kOurs);
  const auto json = nlohmann::json::parse(latency_json(journeys, {"udpm://x", 5.0}));
  EXPECT_EQ(json["bus"], "udpm://x");
  ASSERT_EQ(json["guests"].size(), 1u);
  EXPECT_EQ(json["guests"][0]["id"], "bob");
  EXPECT_EQ(json["guests"][0]["poses"], 1);
  const auto& steps = json["guests"][0]["steps"];
  ASSERT_EQ(steps.size(), 7u);
  EXPECT_EQ(steps[1]["from"], "published");
  EXPECT_EQ(steps[1]["to"], "link_sent");
  EXPECT_NEAR(steps[1]["p50_us"].get<double>(), 100.0, 4.0);
  EXPECT_NEAR(steps[6]["since_capture"]["p99_us"].get<double>(), 2110.0, 50.0);
}

}  // namespace
}  // namespace dance
