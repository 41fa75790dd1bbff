// A house that only watches joins a room with its guest's key and publishes no poses there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/program/child_process.h"
#include "tests/apps/run_program.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr const char* kDancer =
    "[house]\nguest = \"ann\"\nserver = \"127.0.0.1\"\nroom = \"salsa\"\n"
    "bus = \"udpm://239.255.76.67:17691?ttl=0\"\n"
    "[[produce]]\nkind = \"salsa\"\nguest = \"ann\"\n";

class WatchingHouse : public testing::Test {
 protected:
  void SetUp() override {
    setenv("XDG_CONFIG_HOME", folder_.path("config").c_str(), 1);
    setenv("XDG_RUNTIME_DIR", folder_.path("run").c_str(), 1);
    std::filesystem::create_directories(folder_.path("run"));
    server_ = start("dance-server", {}, "server");
    ASSERT_TRUE(wait_for([&] { return says("server", "hears on"); }));
    std::ofstream(folder_.path("house.toml")) << kDancer;
  }
  std::unique_ptr<ChildProcess> start(const std::string& program,
                                      std::vector<std::string> arguments, const std::string& talk) {
    auto started =
        ChildProcess::start({bin(program), std::move(arguments), "", folder_.path(talk)});
    EXPECT_TRUE(started);
    return started ? std::make_unique<ChildProcess>(std::move(*started)) : nullptr;
  }
  bool says(const std::string& talk, const std::string& words) const {
    return text_of(folder_.path(talk)).find(words) != std::string::npos;
  }
  static bool is_there(const std::string& guest) {
    const std::string status = run(bin("dance-status") + " --once --json").output;
    return status.find("\"" + guest + "\"") != std::string::npos;
  }

  TestFolder folder_{"watching"};
  std::unique_ptr<ChildProcess> server_;
};

TEST_F(WatchingHouse, JoinsTheRoomWithoutPublishingPoses) {
  const auto house =
      start("dance-join", {folder_.path("house.toml"), "--no-view", "--watch"}, "house");
  ASSERT_TRUE(wait_for([&] { return says("house", "in room 'salsa'"); }));
  EXPECT_FALSE(is_there("ann")) << text_of(folder_.path("house"));
  house->stop(Duration::s(5));
  const auto dancer = start("dance-join", {folder_.path("house.toml"), "--no-view"}, "dancer");
  EXPECT_TRUE(wait_for([&] { return is_there("ann"); })) << text_of(folder_.path("dancer"));
}

TEST_F(WatchingHouse, PublishesNoPosesIfTheHouseFileHasWatch) {
  std::ofstream(folder_.path("house.toml")) << "[house]\nwatch = true\n"
                                            << std::string(kDancer).substr(8);
  const auto house = start("dance-join", {folder_.path("house.toml"), "--no-view"}, "house");
  ASSERT_TRUE(wait_for([&] { return says("house", "in room 'salsa'"); }));
  EXPECT_FALSE(is_there("ann")) << text_of(folder_.path("house"));
}

}  // namespace
}  // namespace dance
