// What is told to the haptics of a guest that run: by sockets in a folder of the test.
#include "haptics/haptic_control.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>

#include "core/net/local_address.h"
#include "core/net/mono_clock.h"
#include "haptics/haptic_table.h"
#include "tests/core/bus/port_double.h"
#include "tests/haptics/haptic_notes.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr const char* kControlBus = "memq://";
const GuestId kTold = *GuestId::parse("alice");

class HapticControls : public ::testing::Test {
 protected:
  struct Device {
    DeviceNotes notes;
    std::unique_ptr<HapticFeed> feed;
  };
  void SetUp() override {
    ::setenv("XDG_RUNTIME_DIR", folder_.path("").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    for (Device& device : devices_) {
      device.feed = std::make_unique<HapticFeed>(kTold, HapticMakerOptions(), port_, *poller_);
      device.feed->add(std::make_unique<HapticPlayer>(std::make_unique<NotedOutput>(device.notes),
                                                      HapticPlayerOptions(), *poller_));
    }
  }
  Result<std::unique_ptr<HapticControl>> open() {
    return HapticControl::open(
        kControlBus, {devices_[0].feed.get(), devices_[1].feed.get()},
        [this](const std::string& line) { said_.push_back(line); }, *poller_);
  }
  void turn() {
    for (int i = 0; i < 20; ++i) poller_->run_once(Duration::ms(5));
  }

  TestFolder folder_{"haptic-control"};
  PortDouble port_;
  std::unique_ptr<Poller> poller_ = *Poller::create();
  std::array<Device, 2> devices_;
  std::vector<std::string> said_;
};

TEST_F(HapticControls, AllDevicesOfAGuestAreOffAndOnAgainAndKeepToALimit) {
  const auto control = open();
  ASSERT_TRUE(control) << control.error().what;
  const auto tell = [&](const HapticCommand& command) {
    const auto told = tell_haptics(kControlBus, kTold, command);
    ASSERT_TRUE(told) << told.error().what;
    EXPECT_EQ(*told, 1);
    turn();
  };
  using Kind = HapticCommand::Kind;
  tell({Kind::kOff, 1.0f});
  for (const Device& device : devices_) {
    EXPECT_FALSE(device.feed->is_on());
    EXPECT_EQ(device.notes.stops, 1);
  }
  tell({Kind::kLimit, 0.4f});
  tell({Kind::kOn, 1.0f});
  for (const Device& device : devices_) {
    EXPECT_TRUE(device.feed->is_on());
    EXPECT_FLOAT_EQ(device.notes.limit, 0.4f);
  }
  EXPECT_EQ(said_, (std::vector<std::string>{"alice: haptics are off",
                                             "alice feels nothing stronger than 0.40",
                                             "alice: haptics are on"}));
}

TEST_F(HapticControls, WhereNothingRunsItIsSaid) {
  const auto nobody = tell_haptics(kControlBus, kTold, {});
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().what.find("[[haptics]]"), std::string::npos);
  {
    const auto control = open();
    ASSERT_TRUE(control);
    EXPECT_FALSE(tell_haptics(kControlBus, *GuestId::parse("bob"), {}));
    EXPECT_FALSE(tell_haptics("memq://other", kTold, {}));
  }
  EXPECT_FALSE(tell_haptics(kControlBus, kTold, {}));
}

// A killed program leaves its socket.
TEST_F(HapticControls, SocketsOfKilledProgramsDoNotHideOneThatRuns) {
  const auto control = open();
  ASSERT_TRUE(control);
  const std::string path = control_path("haptics", kControlBus, kTold);
  sockaddr_un address{};
  for (std::uint64_t number = 1; number <= 300; ++number) {
    address = *unix_address(numbered_control_path(path, 10'000'000 + number));
    const int left = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ASSERT_EQ(::bind(left, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(left);
  }
  const auto told = tell_haptics(kControlBus, kTold, {HapticCommand::Kind::kOff, 1.0f});
  ASSERT_TRUE(told) << told.error().what;
  EXPECT_EQ(*told, 1);
  turn();
  EXPECT_FALSE(devices_[0].feed->is_on());
  EXPECT_NE(::access(address.sun_path, F_OK), 0) << "what nobody serves is to go";
}

TEST_F(HapticControls, WhatIsNoCommandChangesNothing) {
  const auto control = open();
  ASSERT_TRUE(control);
  const auto paths = numbered_control_paths(control_path("haptics", kControlBus, kTold));
  ASSERT_EQ(paths.size(), 1u);
  for (const char* text : {"", "o", "offf", "limit", "limit ", "limit 2", "limit -0.1", "limit nan",
                           "limit 0.5x", "\x1b[2J"}) {
    EXPECT_FALSE(parse_haptic_command(text)) << text;
    ASSERT_TRUE(send_to_program(paths[0], text));
  }
  turn();
  EXPECT_EQ((*control)->refused(), 10u);
  EXPECT_TRUE(said_.empty());
  EXPECT_TRUE(devices_[0].feed->is_on());
}

}  // namespace
}  // namespace dance
