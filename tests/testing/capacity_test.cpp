// Lines of recorded capacity: exact times, by a clock of the test's own.
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "testing/line/capacity_queue.h"
#include "testing/line/lossy_model.h"

namespace dance {
namespace {

constexpr std::size_t kWhole = CapacityTrace::kOpportunity_bytes;
const MonoTime kStart = MonoTime::from_us(1'000'000);
constexpr Duration kTimeout = Duration::s(10);

std::shared_ptr<const CapacityTrace> capacity(const char* text) {
  auto trace = CapacityTrace::parse(text);
  EXPECT_TRUE(trace) << (trace ? "" : trace.error().what);
  return std::make_shared<const CapacityTrace>(std::move(*trace));
}

// When it leaves, in ms; -1 = never.
double leaves_ms(CapacityQueue& queue, std::size_t bytes, double now_ms,
                 Duration longest = kTimeout) {
  const auto left = queue.take(bytes, Duration::seconds(now_ms * 1e-3), longest);
  return left ? left->as_ms() : -1.0;
}

TEST(CapacityTrace, SaysEachOpportunityOfEachRound) {
  const auto trace = capacity("0\n3\n3\r\n10");
  EXPECT_EQ(trace->size(), 4u);
  EXPECT_EQ(trace->length(), Duration::ms(10));
  EXPECT_DOUBLE_EQ(trace->mean_bps(), 4 * 1500 * 8 / 0.010);
  const std::vector<int> expected_ms{0, 3, 3, 10, 10, 13, 13, 20, 20};
  for (std::size_t i = 0; i < expected_ms.size(); ++i)
    EXPECT_EQ(trace->at(i), Duration::ms(expected_ms[i])) << i;
  for (const auto& [ms, first] : std::vector<std::pair<double, std::uint64_t>>{
           {0, 0}, {0.001, 1}, {3, 1}, {3.5, 3}, {10, 3}, {10.001, 5}, {20, 7}, {23, 9}})
    EXPECT_EQ(trace->first_from(Duration::seconds(ms * 1e-3)), first) << ms;
}

TEST(CapacityTrace, FindsWhatAWalkThroughAllRoundsFinds) {
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    std::string text;
    int ms = 0;
    for (int i = 0; i < 8; ++i)
      text += std::to_string(ms += static_cast<int>(random.uniform(0.0, 4.0))) + "\n";
    text += std::to_string(ms + 1);
    const auto trace = capacity(text.c_str());
    for (std::int64_t us = 0; us < 100'000; us += 250) {
      CapacityTrace::Number walked = 0;
      while (trace->at(walked) < Duration::us(us)) ++walked;
      ASSERT_EQ(trace->first_from(Duration::us(us)), walked) << text << " at " << us << " µs";
    }
  }
}

TEST(CapacityTrace, NamesTheLineThatIsBrokenAndWhatItShouldBe) {
  const auto expect_error = [](const char* text, const char* part) {
    const auto trace = parse_trace(text);
    ASSERT_FALSE(trace) << text;
    EXPECT_NE(trace.error().what.find(part), std::string::npos) << trace.error().what;
  };
  expect_error("", "no rows");
  expect_error("\n\n", "no rows");
  expect_error("1\n2\nx\n", "line 3: a capacity trace has a whole number of milliseconds");
  expect_error("1\n2.5\n", "'2.5'");
  expect_error("1\n-2\n", "'-2'");
  expect_error("1\n99999999999\n", "'99999999999'");
  expect_error("5\n4\n", "line 2: time goes backwards: '4'");
  expect_error("0\n0\n", "line 2: the last number is the trace's length");
  expect_error("1.5\n2\n", "line 1: a trace begins with a header");
  expect_error("\x01\x02zz\n", "'??zz'");
}

TEST(CapacityQueue, CarriesSeveralInOneOpportunityAndOneOverSeveral) {
  CapacityQueue queue(capacity("10\n20\n30\n40\n"));
  EXPECT_EQ(leaves_ms(queue, 500, 0), 10);
  EXPECT_EQ(leaves_ms(queue, 500, 0), 10);
  EXPECT_EQ(leaves_ms(queue, 600, 0), 20) << "100 of it do not fit any more";
  EXPECT_EQ(leaves_ms(queue, 2 * kWhole, 11), 40) << "1400 at 20, 1500 at 30, 100 at 40";
  EXPECT_EQ(leaves_ms(queue, kWhole - 100, 40), 40) << "the rest of the one at this moment";
  EXPECT_EQ(leaves_ms(queue, 1, 40), 50) << "the next round";
}

TEST(CapacityQueue, LosesWhatNobodyWaitsFor) {
  CapacityQueue queue(capacity("10\n20\n30\n40\n"));
  EXPECT_EQ(leaves_ms(queue, kWhole, 25), 30);
  EXPECT_EQ(leaves_ms(queue, kWhole, 25), 40);
  EXPECT_EQ(leaves_ms(queue, kWhole, 139), 140);
  EXPECT_EQ(leaves_ms(queue, kWhole, 139), 150);
}

TEST(CapacityQueue, RefusesWhatWouldWaitTooLongAndKeepsItsPlaceForOthers) {
  CapacityQueue queue(capacity("10\n20\n30\n40\n"));
  const Duration longest = Duration::ms(20);
  EXPECT_EQ(leaves_ms(queue, kWhole, 0, longest), 10);
  EXPECT_EQ(leaves_ms(queue, kWhole, 0, longest), 20);
  EXPECT_EQ(leaves_ms(queue, 100, 0, longest), -1) << "would leave at 30";
  EXPECT_EQ(leaves_ms(queue, kWhole, 10, longest), 30) << "what was refused took nothing";
  EXPECT_EQ(leaves_ms(queue, 3 * kWhole, 10, longest), -1);
}

TEST(LossyModel, CarriesWhatItsCapacityCarriesAndDropsWhatWaitsTooLong) {
  // 4 opportunities in 10 ms, then none for 90 ms; queue=50ms.
  LossyWay way{.spec = *LossySpec::parse("delay=5ms queue=50ms"),
               .capacity = capacity("0\n3\n6\n9\n100\n")};
  LossyModel line(way, 0);
  const auto arrives_ms = [&](std::size_t bytes, double at_ms) {
    const auto fate = line.offer(bytes, kStart + Duration::seconds(at_ms * 1e-3));
    return fate.deliveries().empty() ? -1.0 : (fate.deliveries()[0] - kStart).as_ms();
  };
  EXPECT_EQ(arrives_ms(kWhole - 28, 0), 5) << "with the 28 bytes of IP and UDP, all of one";
  EXPECT_EQ(arrives_ms(100, 0), 8);
  EXPECT_EQ(arrives_ms(100, 1), 8) << "beside the one before";
  EXPECT_EQ(arrives_ms(100, 40), -1) << "would wait 60 ms";
  EXPECT_EQ(arrives_ms(100, 50), 105);
  EXPECT_EQ(arrives_ms(100, 101), 108) << "the trace again";
  EXPECT_EQ(line.counters().queue_dropped, 1u);
  EXPECT_EQ(line.counters().forwarded, 5u);
}

TEST(LossyModel, CombinesRateCapacityAndDelaysOfSeveralTracesFromAnOffset) {
  LossyWay way{.spec = *LossySpec::parse("delay=1ms rate=1Mbit queue=1s"),
               .capacity = capacity("5\n25\n45\n1000\n"),
               .offset = Duration::ms(20)};
  for (const char* text : {"t_ms,owd_var_ms\n0,100\n20,7\n500,1\n", "t_ms,rtt_ms\n0,60\n500,1\n"})
    way.delays.push_back(std::make_shared<const DelayTrace>(*DelayTrace::parse(text)));
  LossyModel line(way, 0);
  const auto fate = line.offer(972, kStart);
  ASSERT_EQ(fate.deliveries().size(), 1u);
  // 8 ms at the rate, until 28 of the trace; out at 45, which is 25 from the start; 1 + 7 + 30
  // after.
  EXPECT_EQ((fate.deliveries()[0] - kStart).as_ms(), 25 + 38);
}

TEST(LossyModel, HasAThroughputOfItsCapacity) {
  LossyWay way{.spec = *LossySpec::parse("queue=30ms"), .capacity = capacity("1\n2\n2\n7\n")};
  LossyModel line(way, 0);
  // Twice as much as it carries: 4 in 7 ms.
  std::uint64_t carried = 0;
  Duration longest;
  for (int i = 0; i < 8'000; ++i) {
    const MonoTime now = kStart + Duration::us(875 * i);
    const auto fate = line.offer(kWhole - 28, now);
    for (const MonoTime due : fate.deliveries()) {
      ++carried;
      longest = std::max(longest, due - now);
    }
  }
  EXPECT_NEAR(static_cast<double>(carried), 4'000.0, 25.0);
  EXPECT_LE(longest, Duration::ms(30));
  EXPECT_EQ(line.counters().queue_dropped, 8'000 - carried);
}

TEST(LossyLine, TellsWhatItTakesAndWhenNothingPasses) {
  LossyWay way{.spec = *LossySpec::parse("delay=5ms queue=50ms"),
               .capacity = capacity("10\n20\n200\n"),
               .offset = Duration::ms(3)};
  way.delays.push_back(std::make_shared<const DelayTrace>(
      *DelayTrace::parse("t_ms,rtt_ms\n0,20\n15,\n18,60\n400,2\n")));
  const auto takes_ms = [&](double at_ms) {
    const auto took = time_on(way, Duration::seconds(at_ms * 1e-3));
    return took ? took->as_ms() : -1.0;
  };
  EXPECT_EQ(takes_ms(0), 7 + 10 + 5) << "to the opportunity at 10, half a round trip, 5";
  EXPECT_EQ(takes_ms(12), -1) << "the delay trace loses all";
  EXPECT_EQ(takes_ms(16), 1 + 30 + 5);
  EXPECT_EQ(takes_ms(18), -1) << "nothing leaves for 179 ms";
  EXPECT_EQ(takes_ms(147), 50 + 30 + 5);
  way.spec.loss = 1.0;
  EXPECT_EQ(takes_ms(0), -1);
}

TEST(LossyLine, TakesWordsAndTracesOfEachWay) {
  const auto line = load_line({.link = "delay=10ms loss=1%", .link_up = "delay=30ms rate=1Mbit"});
  ASSERT_TRUE(line) << line.error().what;
  EXPECT_EQ(line->up.spec.delay, Duration::ms(30));
  EXPECT_DOUBLE_EQ(line->up.spec.loss, 0.01);
  EXPECT_DOUBLE_EQ(line->up.spec.rate_bps, 1e6);
  EXPECT_EQ(line->down.spec.delay, Duration::ms(10));
  EXPECT_DOUBLE_EQ(line->down.spec.rate_bps, 0.0);
  const auto missing = load_line({.traces_up = {"/no/such/trace"}});
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("/no/such/trace: no such file"), std::string::npos);
}

TEST(LossyLine, ReadsRecordedCapacitiesAndRefusesTwoOfOneWay) {
  const std::filesystem::path folder = DANCE_SOURCE_DIR "/../shared/data/traces";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  const std::string up = folder / "mahimahi_Verizon-LTE-short.up.xz";
  const std::string down = folder / "mahimahi_Verizon-LTE-short.down.xz";
  const auto line = load_line({.traces = {folder / "ethernet_owd.csv.xz"},
                               .traces_up = {up},
                               .traces_down = {down},
                               .offset_s = 3.0});
  ASSERT_TRUE(line) << line.error().what;
  EXPECT_EQ(line->up.capacity->length(), Duration::s(140));
  EXPECT_NEAR(line->up.capacity->mean_bps() * 1e-6, 5.95, 0.01);
  EXPECT_NEAR(line->down.capacity->mean_bps() * 1e-6, 5.03, 0.01);
  EXPECT_EQ(line->up.delays.size(), 1u);
  EXPECT_EQ(line->down.offset, Duration::s(3));
  const auto two = load_line({.traces = {up}, .traces_down = {down}});
  ASSERT_FALSE(two);
  EXPECT_NE(two.error().what.find("second capacity trace of the way down"), std::string::npos)
      << two.error().what;
}

}  // namespace
}  // namespace dance
