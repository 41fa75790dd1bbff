// The program dance-listen on a real bus, in a network of its own.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "formats/bvh/bvh.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7741?ttl=0";
const std::string kListen = std::string(DANCE_BINARY_DIR) + "/bin/dance-listen";

// dance-listen, with its stdout in a file; ends with the test.
ChildProcess start_listen(const std::vector<std::string>& arguments, const std::string& output) {
  auto child =
      ChildProcess::start({.program = kListen, .arguments = arguments, .output_file = output});
  EXPECT_TRUE(child) << child.error().what;
  return std::move(*child);
}

class Listen : public testing::Test {
 protected:
  void SetUp() override {
    output_ = testing::TempDir() + "listen_" +
              testing::UnitTest::GetInstance()->current_test_info()->name();
    auto bus = Bus::open(kUrl);
    ASSERT_TRUE(bus.has_value()) << bus.error().what;
    bus_ = std::move(*bus);
  }
  void TearDown() override { std::remove(output_.c_str()); }

  // Alice and bob dance on the stage until `is_over`.
  void dance_until(const std::function<bool()>& is_over) {
    const GuestId alice = *GuestId::parse("alice"), bob = *GuestId::parse("bob");
    Pose pose;
    pose.clock_id = this_clock_id();
    while (!is_over()) {
      ++pose.sequence;
      pose.capture_time = mono_now();
      TimedSkeleton timed{average_skeleton(1.6f), pose.capture_time, pose.clock_id};
      bus_->publish(Channel::of(Signal::kSkeleton, Where::kStage, alice), timed);
      bus_->publish(Channel::of(Signal::kPose, Where::kStage, alice), pose);
      bus_->publish(Channel::of(Signal::kPose, Where::kStage, bob), pose);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  std::vector<std::string> lines() const {
    std::ifstream file(output_);
    std::vector<std::string> all;
    for (std::string line; std::getline(file, line);) all.push_back(line);
    return all;
  }

  std::string output_;
  std::unique_ptr<Bus> bus_;
};

TEST_F(Listen, WritesATableOfTheOneGuestAskedForAndEndsByItself) {
  ChildProcess child =
      start_listen({"--bus", kUrl, "--to", "csv", "--guest", "bob", "--seconds", "1"}, output_);
  dance_until([&] { return child.has_ended(); });
  EXPECT_EQ(child.exit_code(), 0);
  const auto all = lines();
  ASSERT_GT(all.size(), 2u);
  EXPECT_TRUE(all[0].starts_with("heard_us,"));
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_NE(all[i].find(",bob,"), std::string::npos) << all[i];
}

TEST_F(Listen, ShowsPosesAsTheyComeAndWritesWholeLinesWhenToldToStop) {
  ChildProcess child = start_listen({"--bus", kUrl}, output_);
  // Lines are there while it still listens: nothing waits for the end.
  dance_until([&] { return lines().size() > 20 || child.has_ended(); });
  ASSERT_FALSE(child.has_ended());
  child.ask_to_stop();
  dance_until([&] { return child.has_ended(); });
  EXPECT_EQ(child.exit_code(), 0);
  bool has_alice = false, has_bob = false;
  for (const std::string& line : lines()) {
    EXPECT_TRUE(line.ends_with(" bones seen")) << line;
    has_alice = has_alice || line.find("  alice  #") != std::string::npos;
    has_bob = has_bob || line.find("  bob  #") != std::string::npos;
  }
  EXPECT_TRUE(has_alice);
  EXPECT_TRUE(has_bob);
}

TEST_F(Listen, WritesABvhWhenToldToStop) {
  const std::string path = output_ + ".bvh";
  ChildProcess child = start_listen(
      {"--bus", kUrl, "--to", "bvh", "--guest", "alice", "-o", path, "--seconds", "1"}, output_);
  dance_until([&] { return child.has_ended(); });
  EXPECT_EQ(child.exit_code(), 0);
  const auto bvh = read_bvh(text_of(path));
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  EXPECT_GT(bvh->frame_count, 1u);
  EXPECT_TRUE(lines().empty());  // stdout is data, and the data went to the file
  std::filesystem::remove(path);
}

TEST_F(Listen, EndsWithOneWhereNothingCanBeWrittenAndWithTwoOnWrongUse) {
  const auto code_of = [this](std::vector<std::string> arguments) {
    ChildProcess child = start_listen(arguments, output_);
    while (!child.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return child.exit_code();
  };
  EXPECT_EQ(code_of({"--bus", kUrl, "-o", "/no/such/folder/x", "--seconds", "1"}), 1);
  EXPECT_EQ(code_of({"--bus", kUrl, "--to", "bvh", "--guest", "nobody", "--seconds", "0.2"}), 1);
  EXPECT_EQ(code_of({"--to", "midi"}), 2);
  EXPECT_EQ(code_of({"--hz", "-1"}), 2);
  EXPECT_EQ(code_of({"--hz", "1e-12"}), 2);
  EXPECT_EQ(code_of({"--nothing"}), 2);
  EXPECT_EQ(code_of({"--help"}), 0);
}

}  // namespace
}  // namespace dance
