#include "transformers/flow.h"

#include <gtest/gtest.h>

#include "producers/salsa/salsa_dancer.h"
#include "tests/allocation_guard.h"
#include "transformers/settings.h"

namespace dance {
namespace {

TEST(ParseDuration, TakesTheUnitsPeopleWrite) {
  EXPECT_EQ(parse_duration("20ms").value(), Duration::ms(20));
  EXPECT_EQ(parse_duration("1.5s").value(), Duration::ms(1500));
  EXPECT_EQ(parse_duration("800us").value(), Duration::us(800));
  EXPECT_EQ(parse_duration("0ms").value(), Duration());
}

TEST(ParseDuration, RefusesWhatIsNoLengthOfTime) {
  for (const char* text :
       {"", "20", "ms", "20 ms", "20m", "nanms", "infs", "1e9s", "--3ms", "20msx"})
    EXPECT_FALSE(parse_duration(text)) << text;
}

std::string error_of(const std::vector<std::string>& through) {
  const auto flow = Flow::make(through);
  return flow ? "" : flow.error().what;
}

TEST(Flow, WithoutWordsPassesThrough) {
  const auto flow = Flow::make({});
  ASSERT_TRUE(flow);
  EXPECT_TRUE(flow->is_pass_through());
}

TEST(Flow, NamesTheWordItDoesNotKnowAndThoseItDoes) {
  const std::string error = error_of({"hodl 20ms"});
  EXPECT_NE(error.find("hodl 20ms"), std::string::npos);
  EXPECT_NE(error.find("hold"), std::string::npos);
}

TEST(Flow, RefusesArgumentsThatMakeNoSense) {
  for (const char* text : {"hold 20ms 30ms", "hold -5ms", "hold 3s", "", "   "})
    EXPECT_NE(error_of({text}), "") << text;
}

TEST(Flow, AHoldWithoutATimeFindsItsOwn) { EXPECT_EQ(error_of({"hold"}), ""); }

// Of a clock that is a little ahead, and of another house's while the line gets faster.
TEST(Flow, StylizeAloneShowsTheNewestPoseAsItCame) {
  for (const int ahead_ms : {50, -90'000}) {
    auto flow = Flow::make({"stylize hips=1"});
    ASSERT_TRUE(flow);
    for (int i = 0; i < 60; ++i) {
      Pose pose;
      pose.sequence = static_cast<std::uint32_t>(i);
      pose.clock_id = 1;
      const MonoTime now = MonoTime::from_us(100'000'000 + 16'000 * i);
      pose.capture_time = now + Duration::ms(i < 30 ? ahead_ms : ahead_ms + 300);
      flow->observe(pose, now);
      Pose out;
      ASSERT_TRUE(flow->sample(now, out));
      EXPECT_EQ(out.capture_time, pose.capture_time) << ahead_ms << ' ' << i;
    }
    EXPECT_EQ(flow->counters().starved, 0u);
  }
}

TEST(Flow, TakesManyBlanks) { EXPECT_EQ(error_of({"  hold   20ms  "}), ""); }

// Every word of a route, with arguments that it takes, in the order in which they stand there.
const std::vector<std::string> kAllWords{"hold 20ms",      "predict",          "bridge",
                                         "rhythm beats=1", "stylize hips=1.3", "hold-hands"};

TEST(Flow, TakesEverySubsetOfTheWordsInTheirOrder) {
  for (unsigned which = 0; which < 1u << kAllWords.size(); ++which) {
    std::vector<std::string> through;
    for (std::size_t i = 0; i < kAllWords.size(); ++i)
      if (which >> i & 1u) through.push_back(kAllWords[i]);
    EXPECT_EQ(error_of(through), "") << which;
  }
}

TEST(Flow, NoTwoWordsMayChangePlaces) {
  for (std::size_t i = 0; i < kAllWords.size(); ++i)
    for (std::size_t j = i + 1; j < kAllWords.size(); ++j) {
      std::vector<std::string> through = kAllWords;
      std::swap(through[i], through[j]);
      EXPECT_NE(error_of(through).find("the right order is"), std::string::npos) << i << ' ' << j;
      EXPECT_NE(error_of({kAllWords[j], kAllWords[i]}), "") << i << ' ' << j;
    }
}

TEST(Flow, AnOrderThatMakesNoSenseIsAnErrorWithTheRightOne) {
  EXPECT_EQ(error_of({"predict", "stylize hips=1.3", "rhythm beats=1"}),
            "'stylize' cannot stand before 'rhythm'; the right order is: "
            "[\"predict\", \"rhythm beats=1\", \"stylize hips=1.3\"]");
  EXPECT_NE(error_of({"predict", "hold 20ms"}).find("[\"hold 20ms\", \"predict\"]"),
            std::string::npos);
  EXPECT_NE(error_of({"rhythm", "bridge"}).find("[\"bridge\", \"rhythm\"]"), std::string::npos);
  EXPECT_NE(error_of({"bridge", "predict"}), "");
}

TEST(Flow, AWordThatStandsTwiceIsAnError) {
  EXPECT_NE(error_of({"hold 20ms", "hold 1s"}).find("'hold' stands twice"), std::string::npos);
  EXPECT_NE(error_of({"stylize hips=1.3", "predict", "stylize arms=2"}).find("'stylize' stands"),
            std::string::npos);
}

TEST(Flow, CountsARefusedPoseOnceHoweverManyWordsThereAre) {
  Flow flow = *Flow::make({"hold 20ms", "predict", "bridge", "rhythm", "stylize"});
  Pose pose;
  pose.clock_id = 1;
  pose.capture_time = MonoTime::from_us(2'000'000);
  flow.observe(pose, MonoTime::from_us(2'000'000));
  flow.observe(pose, MonoTime::from_us(2'001'000));
  EXPECT_EQ(flow.counters().refused, 1u);
  pose.clock_id = 2;
  flow.observe(pose, MonoTime::from_us(2'002'000));
  EXPECT_EQ(flow.counters().restarts, 1u);
}

TEST(Flow, AllocatesNothingPerPoseWhateverTheWords) {
  SalsaDancer dancer{SalsaStyle()};
  std::vector<Pose> dance(600);
  for (std::size_t i = 0; i < dance.size(); ++i) {
    dancer.dance_at(Duration::seconds(static_cast<double>(i) / 60.0), dance[i]);
    dance[i].capture_time = MonoTime::from_us(1'000'000 + static_cast<std::int64_t>(i) * 16'667);
    dance[i].clock_id = 1;
  }
  const std::vector<std::vector<std::string>> routes{
      {"hold"},
      {"predict", "bridge"},
      {"hold 20ms", "bridge", "stylize hips=2"},
      {"predict", "bridge", "rhythm", "stylize hips=1.5 legs=1.5"},
  };
  for (const auto& through : routes) {
    Flow flow = *Flow::make(through);
    Beat beat;
    beat.tempo_bpm = 160.0;
    beat.confidence = 1.0f;
    beat.playing = true;
    Pose out;
    const AllocationGuard guard;
    for (std::size_t i = 0; i < dance.size(); ++i) {
      const MonoTime now = dance[i].capture_time + Duration::ms(60);
      beat.time = beat.beat_time = now;
      beat.beat = 160.0 / 60.0 * static_cast<double>(i) / 60.0;
      if (i % 60 == 0) flow.hear(beat);
      // A lapse of a second in the middle.
      if (i < 300 || i > 360) flow.observe(dance[i], now);
      ASSERT_TRUE(flow.sample(now, out));
      ASSERT_TRUE(is_valid(out));
    }
    EXPECT_EQ(guard.allocations(), 0u) << through.back();
  }
}

}  // namespace
}  // namespace dance
