#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "testing/line/lossy_model.h"

namespace dance {
namespace {

const MonoTime kBegin = MonoTime::from_us(1'000'000);

LossySpec spec(const char* text) {
  auto parsed = LossySpec::parse(text);
  EXPECT_TRUE(parsed) << (parsed ? "" : parsed.error().what);
  return *parsed;
}

std::vector<MonoTime> offer(LossyModel& line, std::size_t bytes, MonoTime now) {
  const auto fate = line.offer(bytes, now);
  return {fate.deliveries().begin(), fate.deliveries().end()};
}

TEST(LossySpec, ReadsEveryWord) {
  const LossySpec s = spec(
      "delay=80ms jitter=10ms tail=5ms loss=1% burst=3 dup=0.1% reorder=2% rate=1Mbit queue=50ms "
      "seed=9");
  EXPECT_EQ(s.delay, Duration::ms(80));
  EXPECT_EQ(s.jitter, Duration::ms(10));
  EXPECT_EQ(s.tail, Duration::ms(5));
  EXPECT_DOUBLE_EQ(s.loss, 0.01);
  EXPECT_DOUBLE_EQ(s.burst, 3.0);
  EXPECT_DOUBLE_EQ(s.duplicate, 0.001);
  EXPECT_DOUBLE_EQ(s.reorder, 0.02);
  EXPECT_DOUBLE_EQ(s.rate_bps, 1e6);
  EXPECT_EQ(s.queue, Duration::ms(50));
  EXPECT_EQ(s.seed, 9u);
  EXPECT_EQ(spec("delay=250us,loss=0").delay, Duration::us(250));
  EXPECT_EQ(spec("").delay, Duration());
}

TEST(LossySpec, NamesTheBadWordAndWhatItShouldBe) {
  const auto expect_error = [](const char* text, const char* word, const char* cure) {
    const auto parsed = LossySpec::parse(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_NE(parsed.error().what.find(word), std::string::npos) << parsed.error().what;
    EXPECT_NE(parsed.error().what.find(cure), std::string::npos) << parsed.error().what;
  };
  expect_error("delay=80ms los=1%", "'los=1%'", "loss=");
  expect_error("delay=80", "'delay=80'", "80ms");
  expect_error("delay=-3ms", "'delay=-3ms'", "80ms");
  expect_error("delay=1e9s", "'delay=1e9s'", "60s");
  expect_error("loss=101%", "'loss=101%'", "0% to 100%");
  expect_error("loss=nan%", "'loss=nan%'", "0% to 100%");
  expect_error("loss", "'loss'", "0% to 100%");
  expect_error("burst=0.5", "'burst=0.5'", "1 to 10000");
  expect_error("rate=5", "'rate=5'", "1Mbit");
  expect_error("seed=x", "'seed=x'", "whole number");
}

TEST(LossyModel, APerfectLineDelaysNothing) {
  LossyModel line({}, 0);
  const auto fate = line.offer(100, kBegin);
  ASSERT_EQ(fate.deliveries().size(), 1u);
  EXPECT_EQ(fate.deliveries()[0], kBegin);
}

TEST(LossyModel, LosesAsManyAsAskedInRunsAsLongAsAsked) {
  for (const double burst : {1.0, 4.0}) {
    LossySpec s = spec("loss=5% seed=3");
    s.burst = burst;
    LossyModel line({.spec = s}, 0);
    constexpr int kCount = 400'000;
    int lost = 0;
    int runs = 0;
    bool was_lost = false;
    for (int i = 0; i < kCount; ++i) {
      const bool is_lost = offer(line, 100, kBegin + Duration::ms(i)).empty();
      lost += is_lost;
      runs += is_lost && !was_lost;
      was_lost = is_lost;
    }
    EXPECT_NEAR(lost / double{kCount}, 0.05, 0.003) << burst;
    EXPECT_NEAR(lost / double(runs), burst == 1.0 ? 1.0 / 0.95 : burst, 0.1 * burst);
    EXPECT_EQ(line.counters().lost, static_cast<std::uint64_t>(lost));
    EXPECT_EQ(line.counters().offered, line.counters().lost + line.counters().forwarded);
  }
}

TEST(LossyModel, JitterStaysInItsBoundsAndKeepsOrder) {
  LossyModel line({.spec = spec("delay=50ms jitter=20ms")}, 0);
  MonoTime last;
  Duration shortest = Duration::s(1);
  Duration longest;
  Duration sum;
  constexpr int kCount = 20'000;
  for (int i = 0; i < kCount; ++i) {
    // Far enough apart that none waits for the one before: as evenly spread as they were drawn.
    const MonoTime now = kBegin + Duration::ms((i < kCount / 2 ? 5 : 50) * i);
    const MonoTime due = offer(line, 100, now)[0];
    ASSERT_GE(due, last);
    last = due;
    if (i >= kCount / 2) sum += due - now;
    shortest = std::min(shortest, due - now);
    longest = std::max(longest, due - now);
  }
  EXPECT_GE(shortest, Duration::ms(30));
  EXPECT_LE(longest, Duration::ms(70));
  EXPECT_GT(longest - shortest, Duration::ms(35));
  EXPECT_NEAR((sum / (kCount / 2)).as_ms(), 50.0, 0.5);
}

TEST(LossyModel, ATailHasItsMeanIsOvertakenAndLeavesTheLossesAsTheyAre) {
  LossyModel line({.spec = spec("delay=50ms tail=15ms")}, 0);
  constexpr int kCount = 20'000;
  double sum_ms = 0.0, squares = 0.0;
  int overtaken = 0;
  MonoTime newest;
  for (int i = 0; i < kCount; ++i) {
    const MonoTime now = kBegin + Duration::ms(16 * i);
    const MonoTime due = offer(line, 100, now)[0];
    const double late_ms = (due - now).as_ms() - 50.0;
    ASSERT_GE(late_ms, 0.0);
    sum_ms += late_ms;
    squares += late_ms * late_ms;
    overtaken += due < newest;
    newest = std::max(newest, due);
  }
  const double mean_ms = sum_ms / kCount;
  EXPECT_NEAR(mean_ms, 15.0, 0.4);
  // Of two exponentials: 1/sqrt(2) of the mean.
  EXPECT_NEAR(std::sqrt(squares / kCount - mean_ms * mean_ms), 15.0 * std::sqrt(0.5), 0.6);
  EXPECT_GT(overtaken, kCount / 20);
  EXPECT_EQ(line.counters().reordered, static_cast<std::uint64_t>(overtaken));

  const auto lost = [](const char* words) {
    LossyModel lossy({.spec = spec(words)}, 0);
    std::string text;
    for (int i = 0; i < 1000; ++i)
      text += offer(lossy, 1, kBegin + Duration::ms(i)).empty() ? '-' : '+';
    return text;
  };
  EXPECT_EQ(lost("tail=1ms loss=10%"), lost("tail=40ms loss=10%"));
  EXPECT_EQ(lost("tail=1ms loss=0").find('-'), std::string::npos);
}

TEST(LossyModel, ReordersAndDoublesAsManyAsAsked) {
  LossyModel line({.spec = spec("delay=10ms reorder=2% dup=3%")}, 0);
  MonoTime before;
  int overtaken = 0;
  int doubled = 0;
  constexpr int kCount = 100'000;
  for (int i = 0; i < kCount; ++i) {
    const auto arrivals = offer(line, 100, kBegin + Duration::ms(16 * i));
    if (arrivals.size() == 2) {
      ++doubled;
      ASSERT_GT(arrivals[1], arrivals[0]);
    }
    overtaken += arrivals[0] < before;  // this one overtakes the one before
    before = arrivals[0];
  }
  EXPECT_NEAR(overtaken / double{kCount}, 0.02, 0.003);
  EXPECT_NEAR(doubled / double{kCount}, 0.03, 0.003);
  EXPECT_NEAR(static_cast<double>(line.counters().reordered), overtaken, 0.03 * overtaken);
  EXPECT_EQ(line.counters().duplicated, static_cast<std::uint64_t>(doubled));
}

TEST(LossyModel, ARateLetsThroughItsBitsAndDropsWhatWouldWaitTooLong) {
  LossyModel line({.spec = spec("rate=1Mbit queue=50ms")}, 0);
  // 972 + 28 bytes are 8 ms at 1 Mbit/s; offered every 4 ms, half of them must go.
  std::uint64_t delivered = 0;
  Duration longest;
  for (int i = 0; i < 10'000; ++i) {
    const MonoTime now = kBegin + Duration::ms(4 * i);
    for (const MonoTime due : offer(line, 972, now)) {
      ++delivered;
      longest = std::max(longest, due - now);
    }
  }
  EXPECT_NEAR(static_cast<double>(delivered), 5000.0, 20.0);
  EXPECT_LE(longest, Duration::ms(58));
  EXPECT_EQ(line.counters().queue_dropped, 10'000 - delivered);
}

TEST(LossyModel, TheSameSeedGivesTheSameLineAndTheDirectionsDiffer) {
  const auto fates = [](std::uint64_t stream) {
    LossyModel line({.spec = spec("loss=50% seed=4")}, stream);
    std::string text;
    for (int i = 0; i < 64; ++i)
      text += offer(line, 1, kBegin + Duration::ms(i)).empty() ? '-' : '+';
    return text;
  };
  EXPECT_EQ(fates(0), fates(0));
  EXPECT_NE(fates(0), fates(1));
}

TEST(DelayTrace, ReadsOneWayDelaysAndRoundTripsAndLosses) {
  const auto owd = DelayTrace::parse("t_ms,owd_var_ms\n0.00,3\n10,7.5\n");
  ASSERT_TRUE(owd);
  EXPECT_EQ(owd->at(Duration::ms(5)).delay, Duration::ms(3));
  EXPECT_EQ(owd->at(Duration::ms(10)).delay, Duration::us(7500));
  EXPECT_EQ(owd->at(Duration::ms(25)).delay, Duration::ms(3)) << "repeated after 20 ms";
  const auto rtt = DelayTrace::parse("run,t_s,rtt_ms\r\n0,0.0,40\r\n0,0.2,\r\n1,5.0,60\r\n");
  ASSERT_TRUE(rtt);
  EXPECT_EQ(rtt->at(Duration()).delay, Duration::ms(20));
  EXPECT_EQ(rtt->at(Duration::ms(200)).loss, 1.0f);
  EXPECT_EQ(rtt->at(Duration::ms(400)).delay, Duration::ms(30)) << "runs follow one another";
  const auto loss = DelayTrace::parse("t_s,rtt_ms,loss\n0,40,0.25\n");
  ASSERT_TRUE(loss);
  EXPECT_EQ(loss->at(Duration()).loss, 0.25f);
}

TEST(DelayTrace, NamesTheLineThatIsBroken) {
  const auto expect_error = [](const char* text, const char* part) {
    const auto trace = DelayTrace::parse(text);
    ASSERT_FALSE(trace) << text;
    EXPECT_NE(trace.error().what.find(part), std::string::npos) << trace.error().what;
  };
  expect_error("", "no rows");
  expect_error("t_s,rtt_ms\n", "no rows");
  expect_error("a,b\n1,2\n", "line 1");
  expect_error("t_s,rtt_ms\n0,1\nx,2\n", "line 3: not a time: 'x'");
  expect_error("t_s,rtt_ms\n0,-1\n", "line 2: not a delay");
  expect_error("t_s,rtt_ms\n0,nan\n", "line 2: not a delay");
  expect_error("t_s,rtt_ms\n1,1\n0,1\n", "line 3: time goes backwards");
  expect_error("t_s,rtt_ms,loss\n0,1,2\n", "line 2: not a loss");
}

TEST(DelayTrace, NamesTheFileThatCannotBeRead) {
  const auto trace = load_trace("/no/such/trace.csv");
  ASSERT_FALSE(trace);
  EXPECT_NE(trace.error().what.find("/no/such/trace.csv"), std::string::npos);
}

TEST(DelayTrace, ReadsTheRecordedLines) {
  const std::filesystem::path folder = DANCE_SOURCE_DIR "/../shared/data/traces";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string path = entry.path();
    if (!path.ends_with(".csv.xz")) continue;
    const auto trace = load_trace(path);
    ASSERT_TRUE(trace) << trace.error().what;
    EXPECT_GT(trace->delay->size(), 500u) << path;
    EXPECT_GT(trace->delay->length(), Duration::s(100)) << path;
    ++read;
  }
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace dance
