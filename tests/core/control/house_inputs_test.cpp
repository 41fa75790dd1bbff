// Tests which captures a house accepts: its own, those of its user's programs, those on the bus.
#include "core/control/house_inputs.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "core/net/mono_clock.h"
#include "tests/core/bus/port_double.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr const char* kInputsUrl = "udpm://239.255.76.67:7813?ttl=0";
const GuestId kOwnGuest = *GuestId::parse("alice");
const GuestId kOtherGuest = *GuestId::parse("bob");

class HouseInputsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller_ = std::move(*made);
  }
  void open(HouseInputs::Options options = {}) {
    options.bus_url = kInputsUrl;
    options.on_refused = [this](const GuestId& guest) { reported_.emplace_back(guest.view()); };
    inputs_ = std::make_unique<HouseInputs>(bus_, bus_, std::move(options), *poller_);
    EXPECT_EQ(inputs_->problem(), "");
    sender_ = std::make_unique<HouseSender>(kInputsUrl, *poller_);
  }
  void subscribe(const GuestId& guest) {
    inputs_->subscribe<Pose>({Where::kCapture, guest},
                             [this](const Channel& channel, const Pose&, MonoTime) {
                               ++poses_[std::string(channel.guest().view())];
                             });
    inputs_->subscribe<Style>({Where::kCapture, guest},
                              [this](const Channel& channel, const Style&, MonoTime) {
                                ++styles_[std::string(channel.guest().view())];
                              });
  }
  template <class T>
  void send(const GuestId& guest, const T& message) {
    sender_->send(Channel::of(MessageTraits<T>::kSignal, Where::kCapture, guest),
                  AnyMessage(message));
    for (int i = 0; i < 3; ++i) poller_->run_once(Duration());
  }
  template <class T>
  void publish_on_bus(const GuestId& guest, const T& message) {
    bus_.publish(Where::kCapture, guest, message);
  }

  TestFolder folder_{"house-inputs"};
  PortDouble bus_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<HouseInputs> inputs_;
  std::unique_ptr<HouseSender> sender_;
  std::map<std::string, int> poses_, styles_;
  std::vector<std::string> reported_;
};

TEST_F(HouseInputsTest, AcceptsCapturesOfAGuestFromTheBusOnlyIfConfigured) {
  HouseInputs::Options options;
  options.from_bus = {kOtherGuest};
  open(std::move(options));
  subscribe(kOwnGuest);
  subscribe(kOtherGuest);
  for (const GuestId& guest : {kOwnGuest, kOtherGuest}) {
    publish_on_bus(guest, Pose());
    publish_on_bus(guest, Style());
  }
  EXPECT_EQ(poses_, (std::map<std::string, int>{{"bob", 1}}));
  EXPECT_EQ(styles_, (std::map<std::string, int>{{"bob", 1}}));
  // A program of this user publishes both ways: each guest's pose is taken once.
  for (const GuestId& guest : {kOwnGuest, kOtherGuest}) {
    send(guest, Pose());
    publish_on_bus(guest, Pose());
  }
  EXPECT_EQ(poses_, (std::map<std::string, int>{{"alice", 1}, {"bob", 2}}));
}

TEST_F(HouseInputsTest, AcceptsOnlyConfiguredGuestsFromTheBusWhenAllAreSubscribed) {
  HouseInputs::Options options;
  options.from_bus = {kOtherGuest};
  open(std::move(options));
  subscribe(GuestId());
  for (const GuestId& guest : {kOwnGuest, kOtherGuest}) {
    publish_on_bus(guest, Pose());
    send(guest, Pose());
  }
  EXPECT_EQ(poses_, (std::map<std::string, int>{{"alice", 1}, {"bob", 1}}));
}

TEST_F(HouseInputsTest, AcceptsAHostedGuestFromThisProcessOnly) {
  HouseInputs::Options options;
  options.hosted = options.from_bus = {kOwnGuest};
  open(std::move(options));
  subscribe(kOwnGuest);
  publish_on_bus(kOwnGuest, Pose());
  send(kOwnGuest, Pose());
  EXPECT_TRUE(poses_.empty());
  const Pose pose;
  inputs_->receive_own(Channel::of(Signal::kPose, Where::kCapture, kOwnGuest), AnyMessage(pose),
                       mono_now());
  EXPECT_EQ(poses_["alice"], 1);
}

TEST_F(HouseInputsTest, IgnoresRequestsOnTheBus) {
  open();
  int removals = 0;
  inputs_->subscribe<Removal>(Where::kLocal,
                              [&](const Channel&, const Removal&, MonoTime) { ++removals; });
  const Removal removal{mono_now(), this_clock_id(), 1, kOtherGuest};
  bus_.publish(Channel::of_house(Signal::kRemoval), removal);
  EXPECT_EQ(removals, 0);
  sender_->send(Channel::of_house(Signal::kRemoval), AnyMessage(removal));
  for (int i = 0; i < 3; ++i) poller_->run_once(Duration());
  EXPECT_EQ(removals, 1);
}

TEST_F(HouseInputsTest, ReportsPosesThatArriveOnTheBusOnly) {
  open();
  subscribe(GuestId());
  // Captures of this user's programs arrive on the bus, too, and are not reported.
  for (std::uint32_t i = 0; i < 3 * HouseInputs::kReportedEach; ++i) {
    publish_on_bus(kOwnGuest, Pose());
    send(kOwnGuest, Pose());
    publish_on_bus(kOtherGuest, Pose());
  }
  EXPECT_EQ(reported_, std::vector<std::string>(3, "bob"));
  EXPECT_EQ(inputs_->refused(), 3u * HouseInputs::kReportedEach);
  const std::string line = refused_poses_line(kOtherGuest);
  EXPECT_NE(line.find("--bus-captures bob"), std::string::npos) << line;
  EXPECT_NE(line.find("bus_captures = [\"bob\"]"), std::string::npos) << line;
}

TEST_F(HouseInputsTest, PassesOtherSubscriptionsToThePort) {
  open();
  int beats = 0;
  inputs_->subscribe<Beat>(Where::kLocal, [&](const Channel&, const Beat&, MonoTime) { ++beats; });
  Beat beat;
  beat.tempo_bpm = 120.0;
  bus_.publish(Channel::of_house(Signal::kBeat), beat);
  EXPECT_EQ(beats, 1);
}

}  // namespace
}  // namespace dance
