// What is hosted in one process is heard there at once, and by others over the bus: never twice.
#include "house/house_port.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/allocation_guard.h"
#include "tests/core/bus/port_double.h"

namespace dance {
namespace {

const GuestId kHere = *GuestId::parse("here");      // danced in this process
const GuestId kBeside = *GuestId::parse("beside");  // by a program of its own

// A bus that brings back what is published on it, as LCM's does.
class HousePortTest : public ::testing::Test {
 protected:
  template <BusMessage T>
  void listen(const From& from) {
    port_.subscribe<T>(from, [this](const Channel& channel, const T&, MonoTime) {
      heard_.emplace_back(channel.view());
    });
  }
  using Names = std::vector<std::string>;

  PortDouble bus_;
  HousePort port_{bus_, {true, {kHere}}};
  Names heard_;
};

TEST_F(HousePortTest, HearsWhatIsHostedOnceAndTheOthersOverTheBus) {
  listen<Pose>(Where::kCapture);
  port_.publish(Where::kCapture, kHere, Pose());
  EXPECT_EQ(heard_, Names{"POSE/capture/here"}) << "not its echo";
  bus_.publish(Where::kCapture, kBeside, Pose());
  EXPECT_EQ(heard_, (Names{"POSE/capture/here", "POSE/capture/beside"}));
  EXPECT_EQ(bus_.sent, heard_) << "all goes over the bus as well";
}

TEST_F(HousePortTest, HearsChoicesOfItsGuestsOverTheBus) {
  listen<Style>(Where::kCapture);
  bus_.publish(Where::kCapture, kHere, Style());
  EXPECT_EQ(heard_, Names{"STYLE/capture/here"});
}

TEST_F(HousePortTest, AsksTheBusForNothingThatIsSaidHere) {
  listen<Pose>(Where::kGuest);
  listen<Style>(Where::kGuest);
  listen<Pose>(Where::kStage);
  listen<Pose>({Where::kCapture, kHere});
  EXPECT_TRUE(bus_.subscriptions.empty());
  port_.publish(Where::kGuest, kBeside, Pose());
  port_.publish(Where::kGuest, kBeside, Style());
  port_.publish(Where::kStage, kBeside, Pose());
  port_.publish(Where::kCapture, kHere, Pose());
  EXPECT_EQ(heard_, (Names{"POSE/guest/beside", "STYLE/guest/beside", "POSE/stage/beside",
                           "POSE/capture/here"}));
}

TEST_F(HousePortTest, WithoutALinkHearsOtherHousesOverTheBus) {
  HousePort port(bus_, {});
  port.subscribe<Pose>(Where::kGuest, [this](const Channel& channel, const Pose&, MonoTime) {
    heard_.emplace_back(channel.view());
  });
  bus_.publish(Where::kGuest, kBeside, Pose());
  EXPECT_EQ(heard_, Names{"POSE/guest/beside"});
}

TEST_F(HousePortTest, KeepsBeatsAndCountsOnTheBus) {
  listen<Beat>(Where::kLocal);
  listen<Stats>(Where::kProgram);
  Beat beat;
  beat.tempo_bpm = 120.0;
  port_.publish(Channel::of_house(Signal::kBeat), beat);
  port_.publish(Channel::of_program(Signal::kStats, "manager"), Stats());
  EXPECT_EQ(heard_, (Names{"BEAT/local", "STATS/manager"})) << "once each";
}

TEST(HousePort, TheStageGoesToTheDisplayFirst) {
  PortDouble bus;
  HousePort port(bus, {});
  std::size_t sent_before = 0;
  const auto note = [&](const Channel&, const Pose&, MonoTime) { sent_before = bus.sent.size(); };
  port.subscribe<Pose>(Where::kStage, note);
  port.publish(Where::kStage, kHere, Pose());
  EXPECT_EQ(sent_before, 1u);
  HousePort of_producer(bus, {false, {kHere}});
  of_producer.subscribe<Pose>(Where::kCapture, note);
  bus.sent.clear();
  of_producer.publish(Where::kCapture, kHere, Pose());
  EXPECT_EQ(sent_before, 0u) << "a capture goes to the link and the stage first";
}

// Stands for a bus that is published on, whose own work is not measured here.
class SilentPort final : public SignalPort {
 public:
  void send(const Channel&, const AnyMessage&) override {}
  void add(std::shared_ptr<Subscription>) override {}
  const Counters& counters() const override { return counted_; }

 private:
  Counters counted_;
};

TEST(HousePort, AllocatesNothingOnTheWayOfAPose) {
  SilentPort bus;
  HousePort port(bus, {true, {kHere}});
  int heard = 0;
  port.subscribe<Pose>(Where::kCapture, [&](const Channel&, const Pose&, MonoTime) { ++heard; });
  const Pose pose;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) port.publish(Where::kCapture, kHere, pose);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(heard, 100);
}

}  // namespace
}  // namespace dance
