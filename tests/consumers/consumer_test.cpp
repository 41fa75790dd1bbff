#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "consumers/consumer_table.h"
#include "consumers/text/bvh_consumer.h"
#include "consumers/text/csv_consumer.h"
#include "consumers/text/text_consumer.h"
#include "formats/bvh/bvh.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr std::uint64_t kOurClock = 77;
const GuestId kAlice = GuestId::parse("alice").value();
const GuestId kBob = GuestId::parse("bob").value();

MonoTime at_ms(double ms) { return MonoTime::from_us(5'000'000) + Duration::seconds(ms * 1e-3); }

Pose pose_at(double ms, std::uint32_t sequence = 1) {
  Pose pose;
  pose.capture_time = at_ms(ms);
  pose.clock_id = kOurClock;
  pose.sequence = sequence;
  pose.p_WH_m = {static_cast<float>(ms), 0.9f, -0.25f};
  return pose;
}

class Consumers : public testing::Test {
 protected:
  void SetUp() override {
    path_ = testing::TempDir() + "consumer_" +
            testing::UnitTest::GetInstance()->current_test_info()->name();
    auto output = OutputFile::open(path_);
    ASSERT_TRUE(output.has_value()) << output.error().what;
    output_ = std::move(*output);
  }
  void TearDown() override { std::remove(path_.c_str()); }

  std::string written() {
    EXPECT_TRUE(output_->flush().has_value());
    return text_of(path_);
  }
  static std::vector<std::string> split(const std::string& text, char by) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, by);) parts.push_back(part);
    if (!text.empty() && text.back() == by && by == ',') parts.emplace_back();
    return parts;
  }

  std::string path_;
  std::shared_ptr<OutputFile> output_;
};

TEST_F(Consumers, WriteALineForEachPoseAsText) {
  TextConsumer consumer(output_, 0.0, kOurClock);
  Pose pose = pose_at(0.0, 41);
  consumer.on_pose(kAlice, pose, at_ms(2.5));
  pose = pose_at(16.0, 42);
  pose.presence = 7;
  pose.music_beats = 12.25;
  consumer.on_pose(kBob, pose, at_ms(20.5));
  ASSERT_TRUE(consumer.finish().has_value());
  EXPECT_EQ(
      written(),
      "0.000 s  alice  #41  age 2.5 ms  hips 0.000 0.900 -0.250 m  22 bones seen\n"
      "0.018 s  bob  #42  age 4.5 ms  hips 16.000 0.900 -0.250 m  3 bones seen  beat 12.25\n");
}

TEST_F(Consumers, TellNoAgeOfAnotherClock) {
  TextConsumer consumer(output_, 0.0, kOurClock);
  Pose pose = pose_at(0.0);
  pose.clock_id = 78;
  consumer.on_pose(kAlice, pose, at_ms(2.5));
  EXPECT_NE(written().find("age ? ms"), std::string::npos);
}

TEST_F(Consumers, WriteNumbersThatReadBackExactlyAsCsv) {
  CsvConsumer consumer(output_, 0.0);
  Random random(61);
  std::vector<Pose> poses;
  for (int i = 0; i < 50; ++i) {
    Pose pose = random_pose(random);
    pose.capture_time = at_ms(i * 10.0);
    pose.clock_id = random.next_u64();
    pose.sequence = static_cast<std::uint32_t>(random.next_u64());
    if (i % 2 == 0) pose.music_beats = random.uniform(0.0, 1000.0);
    poses.push_back(pose);
    consumer.on_pose(kAlice, pose, at_ms(i * 10.0 + 3.0));
  }
  const std::vector<std::string> lines = split(written(), '\n');
  ASSERT_EQ(lines.size(), 51u);
  const std::vector<std::string> header = split(lines[0], ',');
  ASSERT_EQ(header.size(), 11u + 4u * kBoneCount + 3u * (kBoneCount - 1 + kTipCount) + 1u);
  EXPECT_EQ(header[8], "hips_x_m");
  EXPECT_EQ(header[11], "hips_x");
  EXPECT_EQ(header[98], "rightToes_w");
  EXPECT_EQ(header[99], "spine_x_m");
  EXPECT_EQ(header[162], "headTip_x_m");
  EXPECT_EQ(header.back(), "hips_height_m");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::vector<std::string> cells = split(lines[i + 1], ',');
    ASSERT_EQ(cells.size(), header.size());
    EXPECT_EQ(cells[0], std::to_string(at_ms(static_cast<double>(i) * 10.0 + 3.0).since_zero_us()));
    EXPECT_EQ(cells[2], std::to_string(poses[i].clock_id));
    EXPECT_EQ(cells[3], "alice");
    EXPECT_EQ(cells[4], std::to_string(poses[i].sequence));
    EXPECT_EQ(std::stof(cells[6]), poses[i].confidence);
    EXPECT_EQ(cells[7].empty(), std::isnan(poses[i].music_beats));
    EXPECT_EQ(std::stof(cells[8]), poses[i].p_WH_m.x());
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      EXPECT_EQ(std::stof(cells[11 + 4 * b]), poses[i].R_PB[b].x());
      EXPECT_EQ(std::stof(cells[14 + 4 * b]), poses[i].R_PB[b].w());
    }
  }
}

TEST_F(Consumers, FillTheLongestPossibleLine) {
  CsvConsumer csv(output_, 0.0);
  TextConsumer text(output_, 0.0, kOurClock);
  Pose pose = pose_at(0.0, 0xffffffffu);
  pose.clock_id = ~std::uint64_t{0};
  pose.capture_time = MonoTime::from_us(-3'000'000'000'000'000);
  pose.music_beats = -1.7976931348623157e308;
  pose.p_WH_m.setConstant(-1.17549435e-38f);
  for (auto& rotation : pose.R_PB) rotation.coeffs().setConstant(-1.17549435e-38f);
  const GuestId longest = GuestId::parse(std::string(kMaxGuestIdLength, 'w')).value();
  csv.on_pose(longest, pose, MonoTime::from_us(-1));
  text.on_pose(longest, pose, MonoTime::from_us(-1));
  EXPECT_EQ(split(written(), '\n').size(), 3u);
}

TEST_F(Consumers, ThinEachGuestByItself) {
  TextConsumer consumer(output_, 10.0, kOurClock);
  for (int i = 0; i < 600; ++i) {  // ten seconds of 60 Hz, with two milliseconds of jitter
    const double ms = i * 1000.0 / 60.0 + (i % 3);
    consumer.on_pose(kAlice, pose_at(ms), at_ms(ms));
    if (i % 60 == 0) consumer.on_pose(kBob, pose_at(ms), at_ms(ms));
  }
  int alice = 0, bob = 0;
  for (const std::string& line : split(written(), '\n'))
    ++(line.find("alice") != std::string::npos ? alice : bob);
  EXPECT_NEAR(alice, 100, 1);
  EXPECT_EQ(bob, 10);
}

TEST(RateLimit, HalvesSixtyHertzEvenlyAndBeginsAnewWhenTheClockGoesBack) {
  RateLimit limit(30.0);
  int passed = 0;
  for (int i = 0; i < 600; ++i) passed += limit.lets_through(kAlice, at_ms(i * 1000.0 / 60.0));
  EXPECT_NEAR(passed, 300, 1);
  EXPECT_TRUE(limit.lets_through(kAlice, at_ms(-50'000.0)));
  EXPECT_FALSE(limit.lets_through(kAlice, at_ms(-49'990.0)));
}

TEST(RateLimit, HoldsABoundedNumberOfGuests) {
  RateLimit limit(1.0);
  std::size_t passed = 0;
  for (int i = 0; i < 1000; ++i)
    passed += limit.lets_through(*GuestId::parse("g" + std::to_string(i)), at_ms(0.0));
  EXPECT_EQ(passed, RateLimit::kMostGuests);
}

TEST_F(Consumers, PutPosesOnASteadyGridForBvh) {
  BvhConsumer consumer(output_, 50.0, GuestId());
  // 60 Hz with jitter in; the hips' x is the time, so that each frame tells when it is.
  for (int i = 0; i < 120; ++i) {
    const double ms = i * 1000.0 / 60.0 + (i % 4);
    consumer.on_pose(kAlice, pose_at(ms), at_ms(ms));
  }
  const auto& frames = consumer.clip().frames;
  ASSERT_NEAR(static_cast<double>(frames.size()), 100.0, 1.0);
  for (std::size_t k = 0; k < frames.size(); ++k)
    EXPECT_NEAR(frames[k].p_WH_m.x(), 20.0f * static_cast<float>(k), 0.05f);
}

TEST_F(Consumers, WriteABvhThatReadsBack) {
  BvhConsumer consumer(output_, 60.0, GuestId());
  const Skeleton skeleton = average_skeleton(1.6f);
  consumer.on_skeleton(kAlice, skeleton, at_ms(0.0));
  for (int i = 0; i < 60; ++i) {
    const double ms = i * 1000.0 / 60.0;
    consumer.on_pose(kAlice, pose_at(ms), at_ms(ms));
    consumer.on_pose(kBob, pose_at(ms), at_ms(ms));
  }
  ASSERT_TRUE(consumer.finish().has_value());
  const auto bvh = read_bvh(written());
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  EXPECT_EQ(bvh->frame_count, consumer.clip().frames.size());
  EXPECT_NEAR(bvh->frame_hz, 60.0, 0.01);
  EXPECT_NE(consumer.summary().find("60 poses of other guests left out"), std::string::npos)
      << consumer.summary();
  EXPECT_EQ(consumer.summary().find("average"), std::string::npos) << consumer.summary();
}

TEST_F(Consumers, WriteTheFingersOfABvhWhereHandsAreHeard) {
  BvhConsumer consumer(output_, 60.0, GuestId());
  for (int i = 0; i < 10; ++i) {
    const double ms = i * 1000.0 / 60.0;
    consumer.on_pose(kAlice, pose_at(ms), at_ms(ms));
    Hands hands;
    hands.capture_time = at_ms(ms);
    hands.clock_id = kOurClock;
    consumer.on_hands(kAlice, hands, at_ms(ms));
    consumer.on_hands(kBob, hands, at_ms(ms));
  }
  ASSERT_TRUE(consumer.finish().has_value());
  const auto bvh = read_bvh(written());
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  EXPECT_EQ(bvh->joints.size(), kBoneCount + kFingerBoneCount);
}

TEST_F(Consumers, CutSilencesOutAndRefuseOldPosesForBvh) {
  BvhConsumer consumer(output_, 100.0, kAlice);
  for (int i = 0; i <= 10; ++i) consumer.on_pose(kAlice, pose_at(i * 10.0), at_ms(0.0));
  consumer.on_pose(kAlice, pose_at(50.0), at_ms(0.0));  // older: left out
  for (int i = 0; i <= 10; ++i) consumer.on_pose(kAlice, pose_at(1e9 + i * 10.0), at_ms(0.0));
  Pose of_other_clock = pose_at(10.0);
  of_other_clock.clock_id = 1;
  consumer.on_pose(kAlice, of_other_clock, at_ms(0.0));
  EXPECT_EQ(consumer.clip().frames.size(), 11u + 11u + 1u);
  EXPECT_NE(consumer.summary().find("2 silences cut out"), std::string::npos) << consumer.summary();
  EXPECT_NE(consumer.summary().find("1 poses left out"), std::string::npos) << consumer.summary();
}

TEST_F(Consumers, KeepABoundedNumberOfFramesForBvh) {
  BvhConsumer consumer(output_, 100.0, kAlice, 50);
  for (int i = 0; i < 200; ++i) consumer.on_pose(kAlice, pose_at(i * 10.0), at_ms(0.0));
  EXPECT_EQ(consumer.clip().frames.size(), 50u);
  EXPECT_NE(consumer.summary().find("150 frames left out"), std::string::npos)
      << consumer.summary();
}

TEST_F(Consumers, SayThatNobodyWasHeardInsteadOfAnEmptyBvh) {
  BvhConsumer consumer(output_, 60.0, kBob);
  const auto finished = consumer.finish();
  ASSERT_FALSE(finished.has_value());
  EXPECT_NE(finished.error().what.find("no pose was heard of bob"), std::string::npos);
}

TEST_F(Consumers, AllocateNothingPerPoseInTextAndTable) {
  TextConsumer text(output_, 0.0, kOurClock);
  CsvConsumer csv(output_, 0.0);
  output_->write("the first write makes the C library's buffer");
  const Pose pose = pose_at(0.0);
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    text.on_pose(kAlice, pose, at_ms(i));
    csv.on_pose(kAlice, pose, at_ms(i));
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(ConsumerTable, MakesEachConsumerItNames) {
  const std::vector<std::string> names = consumer_names();
  for (const char* name : {"text", "csv", "bvh", "mcap"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  for (const std::string& name : names) {
    ConsumerOptions options;
    if (find_consumer_kind(name)->output == OutputKind::kFile) options.file = "/dev/null";
    if (find_consumer_kind(name)->output == OutputKind::kMemory) options.name = "table-test";
    const auto made = make_consumer(name, options);
    EXPECT_TRUE(made.has_value()) << name << ": " << made.error().what;
  }
  const auto unknown = make_consumer("midi", {});
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().what.find("there is no consumer 'midi'; known are text, csv, bvh"), 0u)
      << unknown.error().what;
}

TEST(ConsumerTable, RefusesOptionsThatAConsumerDoesNotTake) {
  const ConsumerKind kind{"osc", OutputKind::kAddress, "127.0.0.1:1", {"old", "new"}};
  ConsumerOptions options;
  EXPECT_TRUE(check_consumer_options(kind, options).has_value());
  options.dialect = "new";
  EXPECT_TRUE(check_consumer_options(kind, options).has_value());
  options.dialect = "odd";
  EXPECT_EQ(check_consumer_options(kind, options).error().what,
            "'osc' has no dialect 'odd'; it has old, new");
  options.dialect.clear();
  options.file = "x.csv";
  EXPECT_EQ(check_consumer_options(kind, options).error().what,
            "'osc' takes an address, as 127.0.0.1:39539, not a file");
}

TEST(ConsumerTable, RefusesRatesThatHaveNoPeriod) {
  ConsumerOptions options;
  options.file = "/dev/null";
  for (const double hz : {0.0, 0.001, 1000.0}) {
    options.hz = hz;
    EXPECT_TRUE(make_consumer("csv", options).has_value()) << hz;
  }
  for (const double hz : {1e-12, 0.0009, -1.0, 1000.1, std::nan("")}) {
    options.hz = hz;
    const auto made = make_consumer("csv", options);
    ASSERT_FALSE(made.has_value()) << hz;
    EXPECT_NE(made.error().what.find("from 0.001"), std::string::npos) << made.error().what;
  }
}

TEST(OutputFile, NamesAFolderThatIsNotThere) {
  const auto output = OutputFile::open("/no/such/folder/dance.csv");
  ASSERT_FALSE(output.has_value());
  EXPECT_NE(output.error().what.find("/no/such/folder/dance.csv"), std::string::npos);
}

TEST(OutputFile, RemembersThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  auto output = OutputFile::open("/dev/full");
  ASSERT_TRUE(output.has_value());
  (*output)->write("text");
  const auto flushed = (*output)->flush();
  ASSERT_FALSE(flushed.has_value());
  EXPECT_NE(flushed.error().what.find("/dev/full: writing failed"), std::string::npos);
  EXPECT_TRUE((*output)->has_failed());
  EXPECT_FALSE((*output)->flush().has_value());  // and goes on saying so
}

}  // namespace
}  // namespace dance
