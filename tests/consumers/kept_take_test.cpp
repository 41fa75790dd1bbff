#include "consumers/files/kept_take.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "consumers/consumer_table.h"
#include "formats/recording/log_source.h"
#include "formats/recording/recording.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

const GuestId kTakesGuest = GuestId::parse("alice").value();

class KeptTakes : public testing::Test {
 protected:
  std::unique_ptr<PoseConsumer> consumer_of(const char* kind, const std::string& file) {
    ConsumerOptions options;
    options.file = file;
    auto made = make_consumer(kind, options);
    EXPECT_TRUE(made.has_value()) << made.error().what;
    return made ? std::move(*made) : nullptr;
  }
  static void dance(PoseConsumer& consumer) {
    for (int i = 0; i < 120; ++i) {
      Pose pose;
      pose.capture_time = MonoTime::from_us(5'000'000 + i * 16'667);
      pose.clock_id = 7;
      pose.sequence = static_cast<std::uint32_t>(i + 1);
      pose.p_WH_m = {0.01f * static_cast<float>(i), 0.9f, 0.0f};
      consumer.on_pose(kTakesGuest, pose, pose.capture_time);
    }
    consumer.on_second(MonoTime::from_us(7'100'000));
  }
  static std::size_t poses_in(const std::string& log) {
    auto source = LogSource::open(log);
    if (!source) return 0;
    Recording recording;
    EXPECT_TRUE(source->read_into(recording).has_value());
    return recording.guests().empty() ? 0 : recording.guests().front().poses.size();
  }
  TestFolder folder_{"kept-take"};
};

TEST_F(KeptTakes, AreOnTheDiskWhileTheyAreDanced) {
  for (const char* kind : {"bvh", "glb"}) {
    const std::string file = folder_.path(std::string("take.") + kind);
    const auto consumer = consumer_of(kind, file);
    dance(*consumer);
    EXPECT_EQ(poses_in(file + ".lcm"), 120u) << kind;
    ASSERT_TRUE(consumer->finish().has_value());
    EXPECT_FALSE(std::filesystem::exists(file + ".lcm"));
    EXPECT_GT(std::filesystem::file_size(file), 1000u);
  }
}

TEST_F(KeptTakes, StayWhereTheFileCannotBeWrittenAndAreNotOverwritten) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string file = folder_.path("full.bvh");
  std::filesystem::create_symlink("/dev/full", file);
  const auto consumer = consumer_of("bvh", file);
  dance(*consumer);
  const auto finished = consumer->finish();
  ASSERT_FALSE(finished.has_value());
  EXPECT_NE(finished.error().what.find("the take is in " + file + ".lcm"), std::string::npos)
      << finished.error().what;
  EXPECT_EQ(poses_in(file + ".lcm"), 120u);

  ConsumerOptions again;
  again.file = file;
  const auto refused = make_consumer("bvh", again);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().what.find("a take that was not finished"), std::string::npos);
  EXPECT_EQ(poses_in(file + ".lcm"), 120u);
}

TEST_F(KeptTakes, StayIfTheFileLacksAGuest) {
  const std::string file = folder_.path("couple.bvh");
  const auto consumer = consumer_of("bvh", file);
  dance(*consumer);
  Pose partner;
  partner.capture_time = MonoTime::from_us(7'200'000);
  partner.clock_id = 7;
  partner.sequence = 1;
  consumer->on_pose(GuestId::parse("bob").value(), partner, partner.capture_time);
  ASSERT_TRUE(consumer->finish().has_value());
  EXPECT_EQ(consumer->left_out(), 1u);
  EXPECT_EQ(poses_in(file + ".lcm"), 120u);
  EXPECT_NE(consumer->summary().find("all of it is in " + file + ".lcm"), std::string::npos)
      << consumer->summary();
}

TEST_F(KeptTakes, AreNotKeptBesideADevice) {
  const auto consumer = consumer_of("bvh", "/dev/null");
  dance(*consumer);
  EXPECT_FALSE(std::filesystem::exists("/dev/null.lcm"));
  EXPECT_TRUE(consumer->finish().has_value());
}

TEST_F(KeptTakes, LeaveNoFileIfNobodyDances) {
  const std::string file = folder_.path("none.glb");
  EXPECT_FALSE(consumer_of("glb", file)->finish().has_value());
  EXPECT_FALSE(std::filesystem::exists(file + ".lcm"));
}

}  // namespace
}  // namespace dance
