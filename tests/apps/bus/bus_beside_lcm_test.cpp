// LCM's own programs beside ours on a machine whose multicast goes over its network card, and ours
// on a machine without any route.
#include <gtest/gtest.h>

#include "tests/apps/bus/house_on_lan.h"

namespace dance {
namespace {

using BusBesideLcm = HouseOnLan;

TEST_F(BusBesideLcm, LcmLoggerRecordsADancer) {
  if (run("command -v lcm-logger").exit_code != 0) GTEST_SKIP() << "lcm-logger is not installed";
  const std::string log = folder_.path("logger.lcm");
  ChildProcess& logger = start("lcm-logger", {std::string("--lcm-url=") + kDefaultBusUrl, log});
  start("dance-salsa", {"--guest", "bob"});
  EXPECT_TRUE(wait_for([&] {
    std::error_code error;
    const auto size = std::filesystem::file_size(log, error);
    return !error && size > 50'000;
  })) << talk_of("lcm-logger");
  logger.stop(Duration::s(10));
  EXPECT_GT(count_log_of(log)["POSE/capture/bob"], 5);
}

TEST_F(BusBesideLcm, LcmLogplayerIsReceived) {
  if (run("command -v lcm-logplayer").exit_code != 0)
    GTEST_SKIP() << "lcm-logplayer is not installed";
  const std::string log = folder_.path("evening.lcm");
  ChildProcess& record = start("dance-record", {"-o", log});
  ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(log); })) << talk_of("dance-record");
  const Finished played =
      lan_.machine.run(std::string("lcm-logplayer --speed=4 --lcm-url=\"") + kDefaultBusUrl +
                       "\" " DANCE_SOURCE_DIR "/logs/couple.lcm");
  ASSERT_EQ(played.exit_code, 0) << played.talk;
  record.stop(Duration::s(10));
  auto counts = count_log_of(log);
  for (const auto& [channel, count] : count_log_of(DANCE_SOURCE_DIR "/logs/couple.lcm"))
    EXPECT_GT(counts[channel], count / 2) << channel;
}

// LCM's Java library, which lcm-spy is made of.
TEST_F(BusBesideLcm, AJavaProgramReceivesAndIsReceivedOverLoopback) {
  constexpr const char* kJar = "/usr/share/java/lcm.jar";
  if (run("command -v javac").exit_code != 0 || !std::filesystem::exists(kJar))
    GTEST_SKIP() << "javac (default-jdk-headless) and " << kJar
                 << " (liblcm-java) are not both installed";
  ASSERT_EQ(lan_.machine.run("ip route add 224.0.0.0/4 dev lo").exit_code, 0);
  start("dance-salsa", {"--guest", "bob"});
  start("dance-top", {});
  start("java", {"-Djava.net.preferIPv4Stack=true", "-cp", kJar,
                 DANCE_SOURCE_DIR "/tests/apps/bus/LcmListener.java", kDefaultBusUrl});
  EXPECT_TRUE(wait_for([&] {
    return output_of("java").find("POSE/capture/bob") != std::string::npos &&
           output_of("dance-top").find("LIGHT/java") != std::string::npos;
  })) << talk_of("java")
      << output_of("dance-top");
}

TEST_F(BusBesideLcm, OurProgramsNeedNoRoute) {
  ASSERT_EQ(lan_.machine.run("ip route del default && ip link set lan0 down").exit_code, 0);
  open_house();
  ASSERT_EQ(lan_.machine.run("ip route add prohibit 224.0.0.0/4").exit_code, 0);
  EXPECT_TRUE(is_dance_going_on()) << talk_of("dance-join");
}

TEST_F(BusBesideLcm, TheDoctorsFirewallRuleBlocksTheLanButNotThisMachine) {
  if (run("command -v nft lcm-logger").exit_code != 0)
    GTEST_SKIP() << "nft and lcm-logger are not both installed";
  const Finished doctor = lan_.machine.run(bin("dance-doctor"));
  const std::size_t begin = doctor.output.find("nft '");
  ASSERT_NE(begin, std::string::npos) << doctor.output;
  const std::string line = doctor.output.substr(begin, doctor.output.find('\n', begin) - begin);
  std::ofstream(folder_.path("close.sh")) << line << "\n";
  const Finished closed = lan_.machine.run("sh " + folder_.path("close.sh"));
  if (closed.talk.find("Operation not supported") != std::string::npos)
    GTEST_SKIP() << "this kernel lacks a part of nftables: " << closed.talk;
  ASSERT_EQ(closed.exit_code, 0) << line << closed.talk;

  const std::string log = folder_.path("logger.lcm");
  ChildProcess& logger = start("lcm-logger", {std::string("--lcm-url=") + kDefaultBusUrl, log});
  const DatagramSender stranger(lan_.stranger), local(lan_.machine);
  const auto message = [](const std::string& channel) {
    return "LC02" + std::string(4, '\0') + channel + '\0' + std::string(1000, 'x');
  };
  // The logger writes a block at a time.
  EXPECT_TRUE(wait_for([&] {
    stranger.send(kBusGroup, kBusPort, message("LIGHT/stranger"));
    stranger.send(kMachineAddress, kBusPort, message("LIGHT/stranger"));
    for (int i = 0; i < 10; ++i) local.send(kBusGroup, kBusPort, message("LIGHT/local"));
    std::error_code error;
    const auto size = std::filesystem::file_size(log, error);
    return !error && size > 50'000;
  })) << talk_of("lcm-logger");
  logger.stop(Duration::s(10));
  auto counts = count_log_of(log);
  EXPECT_GT(counts["LIGHT/local"], 0);
  EXPECT_EQ(counts["LIGHT/stranger"], 0);
}

}  // namespace
}  // namespace dance
