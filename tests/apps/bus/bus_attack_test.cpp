// Attacks on the bus, from another host of the LAN and from this machine, against the built
// programs.
#include <gtest/gtest.h>

#include <string>

#include "core/base/random.h"
#include "core/bus/encode.h"
#include "tests/apps/bus/house_on_lan.h"

namespace dance {
namespace {

using BusAttack = HouseOnLan;

std::string sequence() { return std::string("\0\0\0\1", 4); }

// A fragment whose offset and size wrap around to a number below the size of its message.
std::string wrapping_fragment(const std::string& channel) {
  return "LC03" + sequence() + std::string("\0\0\1\0", 4) + std::string("\xff\xff\xff\0", 4) +
         std::string("\0\0\0\1", 4) + channel + '\0' + std::string(256, 'x');
}
std::string sixteen_bytes_without_nul() { return "LC02" + sequence() + "\x1b[31mEVI"; }
std::string message(const std::string& channel, const std::string& data) {
  return "LC02" + sequence() + channel + '\0' + data;
}
std::string pose_message(const std::string& channel, std::uint32_t number) {
  Pose pose;
  pose.sequence = number;
  MessageBuffer buffer;
  const std::size_t size = encode(pose, buffer);
  return message(channel, {reinterpret_cast<const char*>(buffer.data()), size});
}

TEST_F(BusAttack, AFragmentWithAWrappingOffsetEndsNeitherJoinNorListen) {
  open_house();
  const DatagramSender stranger(lan_.stranger), local(lan_.machine);
  for (int i = 0; i < 20; ++i)
    for (const char* channel : {"POSE/stage/bob", "POSE/capture/bob", "BEAT/local"}) {
      stranger.send(kMachineAddress, kBusPort, wrapping_fragment(channel));
      stranger.send(kBusGroup, kBusPort, wrapping_fragment(channel));
      local.send(kLoopbackAddress, kBusPort, wrapping_fragment(channel));
      local.send(kBusGroup, kBusPort, wrapping_fragment(channel));
    }
  EXPECT_TRUE(is_dance_going_on()) << talk_of("dance-join") << talk_of("dance-listen");
}

TEST_F(BusAttack, SixteenBytesWithoutNulDoNotEndRecord) {
  const std::string log = folder_.path("evening.lcm");
  ChildProcess& record = start("dance-record", {"-o", log});
  start("dance-salsa", {"--guest", "bob"});
  const auto size_of_log = [&] {
    std::error_code error;
    const auto size = std::filesystem::file_size(log, error);
    return error ? 0 : size;
  };
  ASSERT_TRUE(wait_for([&] { return size_of_log() > 0; })) << talk_of("dance-record");
  const DatagramSender stranger(lan_.stranger), local(lan_.machine);
  for (int i = 0; i < 20; ++i) {
    stranger.send(kMachineAddress, kBusPort, sixteen_bytes_without_nul());
    stranger.send(kBusGroup, kBusPort, sixteen_bytes_without_nul());
    local.send(kBusGroup, kBusPort, sixteen_bytes_without_nul());
  }
  const auto before = size_of_log();
  EXPECT_TRUE(wait_for([&] { return size_of_log() > before + 10'000 || record.has_ended(); }));
  record.stop(Duration::s(10));
  EXPECT_TRUE(record.ended_well()) << record.exit_text() << talk_of("dance-record");
  EXPECT_GT(count_log_of(log)["POSE/capture/bob"], 5);
  EXPECT_NE(talk_of("dance-record").find("refused 20 datagrams that are not messages"),
            std::string::npos)
      << talk_of("dance-record");
}

TEST_F(BusAttack, AnotherHostCannotDanceAsAGuestOfTheHouse) {
  const std::string log = folder_.path("evening.lcm");
  open_house();
  ChildProcess& record = start("dance-record", {"-o", log});
  const DatagramSender stranger(lan_.stranger);
  for (std::uint32_t i = 0; i < 200; ++i)
    for (const std::uint32_t address : {kMachineAddress, kBusGroup})
      for (const char* channel : {"POSE/capture/alice", "POSE/stage/alice"})
        stranger.send(address, kBusPort, pose_message(channel, i));
  EXPECT_TRUE(is_dance_going_on()) << talk_of("dance-join");
  record.stop(Duration::s(10));
  auto counts = count_log_of(log);
  EXPECT_GT(counts["POSE/stage/bob"], 0);
  EXPECT_EQ(counts.count("POSE/capture/alice"), 0u);
  EXPECT_EQ(counts.count("POSE/stage/alice"), 0u);
  EXPECT_EQ(poses_of("alice"), 0u) << output_of("dance-listen");
}

TEST_F(BusAttack, EscapeBytesOfASenderDoNotReachTheTerminal) {
  ChildProcess& record = start("dance-record", {"-o", folder_.path("evening.lcm")});
  ChildProcess& top = start("dance-top", {});
  start("dance-salsa", {"--guest", "bob"});
  ASSERT_TRUE(wait_for([&] { return output_of("dance-top").find("/bob") != std::string::npos; }))
      << talk_of("dance-top");
  const std::string evil = "EVIL/\x1b[31m\x07";
  const DatagramSender stranger(lan_.stranger), local(lan_.machine);
  for (const DatagramSender* sender : {&stranger, &local})
    for (int i = 0; i < 20; ++i) {
      sender->send(kBusGroup, kBusPort, message(evil, "data"));
      sender->send(kBusGroup, kBusPort, sixteen_bytes_without_nul());
      sender->send(kBusGroup, kBusPort, wrapping_fragment(evil));
    }
  local.send(kBusGroup, kBusPort, message("LIGHT/last", "data"));
  EXPECT_TRUE(wait_for([&] {
    return output_of("dance-top").find("LIGHT/last") != std::string::npos;
  })) << output_of("dance-top");
  for (ChildProcess* child : {&record, &top}) {
    child->stop(Duration::s(10));
    EXPECT_TRUE(child->ended_well()) << child->exit_text();
  }
  for (const std::string program : {"dance-record", "dance-top"})
    for (const std::string& text : {output_of(program), talk_of(program)}) {
      EXPECT_EQ(text.find('\x1b'), std::string::npos) << program;
      EXPECT_EQ(text.find('\x07'), std::string::npos) << program;
      EXPECT_EQ(text.find("EVIL"), std::string::npos) << program;
    }
}

TEST_F(BusAttack, OneLineReportsThatABusIsOpenToTheNetwork) {
  const std::string listen = bin("dance-listen") + " --seconds 0.2 --bus ";
  const Finished open = lan_.machine.run(listen + "udpm://239.255.76.67:7667?ttl=1");
  const std::size_t at = open.talk.find("ttl=1 opens it to the network");
  ASSERT_NE(at, std::string::npos) << open.talk;
  EXPECT_EQ(open.talk.find("opens it to the network", at + 10), std::string::npos) << open.talk;
  const Finished closed = lan_.machine.run(listen + "udpm://239.255.76.67:7667?ttl=0");
  EXPECT_EQ(closed.talk.find("opens it to the network"), std::string::npos) << closed.talk;
}

// Returns a hostile datagram; its kind depends on the number.
std::string hostile_datagram(std::uint32_t number, Random& random) {
  std::string noise(64 + random.below(1200), 'x');
  for (std::size_t i = 0; i < 32; ++i) noise[i] = static_cast<char>(random.below(256));
  switch (number % 8) {
    case 0:
      return wrapping_fragment("POSE/stage/bob");
    case 1:
      return sixteen_bytes_without_nul();
    case 2:
      return message("POSE/stage/bob", noise);  // subscribed, but no pose
    case 3:
      return message("POSE/capture/bob", noise);
    case 4:
      return message("EVIL/" + std::to_string(number), noise);
    case 5:
      return noise;
    case 6:
      return pose_message("POSE/capture/evil-" + std::to_string(number % 1000), number);
    default:
      return "LC03" + noise;
  }
}

TEST_F(BusAttack, TheDanceGoesOnBesideTenThousandDatagramsASecond) {
  constexpr int kTicks = 300;
  open_house();
  ChildProcess& record = start("dance-record", {"-o", folder_.path("evening.lcm")});
  start("dance-top", {});
  ASSERT_TRUE(wait_for([&] { return output_of("dance-top").find("/bob") != std::string::npos; }));
  const DatagramSender stranger(lan_.stranger), local(lan_.machine);
  Random random(41);
  const std::size_t before = poses_of("bob");
  for (std::uint32_t tick = 0; tick < kTicks; ++tick) {
    for (std::uint32_t i = 0; i < 50; ++i) {
      const std::string datagram = hostile_datagram(tick * 50 + i, random);
      stranger.send(kBusGroup, kBusPort, datagram);
      local.send(kBusGroup, kBusPort, datagram);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_GT(poses_of("bob"), before + 10) << "poses during the flood";
  EXPECT_TRUE(is_dance_going_on()) << talk_of("dance-join") << talk_of("dance-listen");
  record.stop(Duration::s(10));
  EXPECT_TRUE(record.ended_well()) << record.exit_text();
  const std::string talk = talk_of("dance-record");
  EXPECT_NE(talk.find("fragments of messages longer than a datagram"), std::string::npos) << talk;
  EXPECT_NE(talk.find("datagrams that are not messages"), std::string::npos) << talk;
}

}  // namespace
}  // namespace dance
