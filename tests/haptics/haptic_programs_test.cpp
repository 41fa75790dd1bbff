// What is felt in a house, recorded, and felt again when the recording is played: the programs as a
// user runs them.
#include <gtest/gtest.h>

#include <map>

#include "core/net/udp_socket.h"
#include "formats/log/log_file.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

class HapticPrograms : public BusPrograms {};

// Whether a haptic came to the ear, as OSC writes it.
bool feels(UdpSocket& ear) {
  for (const auto& datagram : ear.receive()) {
    const std::string_view text(reinterpret_cast<const char*>(datagram.bytes.data()),
                                datagram.bytes.size());
    if (text.find("/dance/haptic/") != std::string_view::npos) return true;
  }
  return false;
}

TEST_F(HapticPrograms, WhatACoupleFeelsIsRecordedAndFeltAgainInAReplay) {
  auto ear = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(ear);
  const auto feel_on = [&](const char* bus) {
    start("dance-haptics", {"--guest", "alice", "--to", "osc", "--address",
                            ear->local_address().to_string(), "--bus", bus});
  };
  open_house();
  feel_on(kBus);
  ASSERT_TRUE(wait_for([&] { return feels(*ear); }));
  const std::string log = folder_.path("felt.lcm");
  const Finished record =
      run(bin("dance-record") + " -o " + log + " --seconds 3 --bus " + quoted(kBus));
  ASSERT_EQ(record.exit_code, 0) << record.talk;
  std::map<std::string, int> counts;
  auto events = LogReader::open(log);
  ASSERT_TRUE(events);
  while (const auto event = events->next()) ++counts[std::string(event->channel)];
  EXPECT_GT(counts["TOUCH/stage/alice"], 5);
  EXPECT_GT(counts["TOUCH/stage/bob"], 5);
  EXPECT_GT(counts["HAPTIC/capture/alice"], 0);
  EXPECT_EQ(counts["HAPTIC/capture/bob"], 0);

  end_all();
  while (feels(*ear)) {
  }
  // Without a manager nobody touches: what is felt now was felt then.
  feel_on(kOtherBus);
  start("dance-replay", {log, "--only", "capture", "--bus", kOtherBus});
  EXPECT_TRUE(wait_for([&] { return feels(*ear); })) << text_of(folder_.path("talk"));
}

// At real-time priority, so by a program of its own, which is told things like the house.
TEST_F(HapticPrograms, AHouseRunsHapticsThatAreToBeExactAsAProgramOfItsOwn) {
  ::setenv("XDG_RUNTIME_DIR", folder_.path("").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  auto ear = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(ear);
  std::ofstream(folder_.path("exact.toml"))
      << "[house]\nbus = \"" << kBus << "\"\nguests = [\"alice\", \"bob\"]\n"
      << "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\nrole = \"lead\"\n"
      << "[[produce]]\nkind = \"salsa\"\nguest = \"bob\"\nrole = \"follow\"\n"
      << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n"
      << "[[haptics]]\nguest = \"alice\"\nto = \"osc\"\nrealtime = true\non = false\n"
      << "feel = [\"touch\", \"lead\"]\nfrom = [\"bob\"]\naddress = \""
      << ear->local_address().to_string() << "\"\n";
  start("dance-manager", {folder_.path("exact.toml")});
  const std::string set = bin("dance-haptics-set") + " --guest alice --bus " + quoted(kBus);
  ASSERT_TRUE(wait_for([&] { return run(set + " --limit 0.5").exit_code == 0; }))
      << text_of(folder_.path("talk"));
  EXPECT_FALSE(feels(*ear)) << "it was to begin switched off";
  EXPECT_EQ(run(set + " --on").exit_code, 0);
  EXPECT_TRUE(wait_for([&] { return feels(*ear); })) << text_of(folder_.path("talk"));
}

TEST(HapticProgramErrors, NameTheMissingPartInOneLine) {
  const Finished none = run(bin("dance-haptics"));
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.talk.find("--guest alice --to evdev"), std::string::npos) << none.talk;
  const Finished wrong =
      run(bin("dance-haptics") + " --guest alice --to evdev --device nothing-so");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.talk.find("dance haptics list"), std::string::npos) << wrong.talk;
  const Finished player =
      run(bin("dance-haptics") + " --guest alice --to bhaptics --address 127.0.0.1:15996");
  EXPECT_EQ(player.exit_code, 1);
  EXPECT_NE(player.talk.find(DANCE_HAVE_BHAPTICS ? "no bHaptics Player at 127.0.0.1:15996"
                                                 : "libwebsockets-dev"),
            std::string::npos)
      << player.talk;
  EXPECT_EQ(std::count(player.talk.begin(), player.talk.end(), '\n'), 1) << player.talk;
  const Finished bone = run(bin("dance-haptics") + " --guest alice --to osc --bones left-hand");
  EXPECT_EQ(bone.exit_code, 2);
  EXPECT_NE(bone.talk.find("leftHand"), std::string::npos) << bone.talk;
  const Finished smell = run(bin("dance-haptics") + " --guest alice --to osc --feel smell");
  EXPECT_EQ(smell.exit_code, 2);
  const Finished list = run(bin("dance-haptics") + " list");
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_NE(list.output.find("osc"), std::string::npos);
  const Finished help = run(bin("dance-haptics") + " --help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* example : {"--to bhaptics", "--to sound --device tactors --feel one lead\n"})
    EXPECT_NE((help.output + help.talk).find(example), std::string::npos) << help.output;
}

TEST_F(HapticPrograms, AHousesHapticsAreSwitchedOffAndOnFromAnotherTerminal) {
  ::setenv("XDG_RUNTIME_DIR", folder_.path("").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  auto ear = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(ear);
  std::ofstream(folder_.path("felt.toml"))
      << "[house]\nbus = \"" << kBus << "\"\nguests = [\"alice\", \"bob\"]\n"
      << "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\nrole = \"lead\"\n"
      << "[[produce]]\nkind = \"salsa\"\nguest = \"bob\"\nrole = \"follow\"\n"
      << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n"
      << "[[haptics]]\nguest = \"alice\"\nto = \"osc\"\naddress = \""
      << ear->local_address().to_string() << "\"\n"
      << "[[haptics]]\nguest = \"bob\"\nto = \"evdev\"\ndevice = \"nothing-so\"\n";
  start("dance-manager", {folder_.path("felt.toml")});
  const auto talk = [&] { return text_of(folder_.path("talk")); };
  ASSERT_TRUE(wait_for([&] { return feels(*ear); })) << talk();
  // A gamepad that is not there is not felt by.
  EXPECT_NE(talk().find("alice feels by osc"), std::string::npos) << talk();
  EXPECT_EQ(talk().find("bob feels by"), std::string::npos) << talk();
  EXPECT_NE(talk().find("bob feels nothing by evdev until it is there"), std::string::npos)
      << talk();
  const std::string set = bin("dance-haptics-set") + " --bus " + quoted(kBus);
  const Finished off = run(set + " --guest alice --off");
  ASSERT_EQ(off.exit_code, 0) << off.talk;
  ASSERT_TRUE(wait_for([&] { return talk().find("haptics are off") != std::string::npos; }));
  while (feels(*ear)) {
  }
  const MonoTime settled = mono_now() + Duration::s(2);
  bool has_felt = false;
  while (mono_now() < settled) {
    has_felt = has_felt || feels(*ear);
    ::usleep(10'000);
  }
  EXPECT_FALSE(has_felt);
  EXPECT_EQ(run(set + " --guest alice --limit 0.4 --on").exit_code, 0);
  EXPECT_TRUE(wait_for([&] { return feels(*ear); })) << talk();
  EXPECT_EQ(run(set + " --guest eve --off").exit_code, 1);
  EXPECT_EQ(run(set + " --guest alice").exit_code, 2);
}

}  // namespace
}  // namespace dance
