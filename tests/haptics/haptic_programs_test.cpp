// What is felt in a house, recorded, and felt again when the recording is played: the programs as a
// user runs them.
#include <gtest/gtest.h>

#include <map>

#include "core/net/udp_socket.h"
#include "formats/log/log_file.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

// Whether a haptic came to the ear, as OSC writes it.
bool feels(UdpSocket& ear) {
  for (const auto& datagram : ear.receive()) {
    const std::string_view text(reinterpret_cast<const char*>(datagram.bytes.data()),
                                datagram.bytes.size());
    if (text.find("/dance/haptic/") != std::string_view::npos) return true;
  }
  return false;
}

TEST_F(BusPrograms, WhatACoupleFeelsIsRecordedAndFeltAgainInAReplay) {
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

TEST(HapticPrograms, SayInOneLineWhatIsMissing) {
  const Finished none = run(bin("dance-haptics"));
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.talk.find("--guest alice --to evdev"), std::string::npos) << none.talk;
  const Finished wrong =
      run(bin("dance-haptics") + " --guest alice --to evdev --device nothing-so");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.talk.find("dance haptics list"), std::string::npos) << wrong.talk;
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

}  // namespace
}  // namespace dance
