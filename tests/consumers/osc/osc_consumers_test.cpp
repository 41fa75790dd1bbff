// The consumers of Open Sound Control on real ports, in a network of their own.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "consumers/consumer_table.h"
#include "core/net/udp_socket.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/formats/osc/decoded_osc.h"

namespace dance {
namespace {

const GuestId kOscAlice = *GuestId::parse("alice");
const GuestId kOscBob = *GuestId::parse("bob");

MonoTime osc_time(std::int64_t ms) { return MonoTime::from_us(4'000'000) + Duration::ms(ms); }

class OscConsumers : public testing::Test {
 protected:
  void open(const std::string& name, ConsumerOptions options = {}) {
    options.address = socket_.local_address().to_string();
    auto made = make_consumer(name, options);
    ASSERT_TRUE(made.has_value()) << made.error().what;
    consumer_ = std::move(*made);
  }
  void dance(const GuestId& guest, std::int64_t ms, std::uint64_t clock_id = 1) {
    Pose pose;
    pose.capture_time = osc_time(ms);
    pose.clock_id = clock_id;
    consumer_->on_pose(guest, pose, osc_time(ms + 5));
  }
  std::vector<DecodedOsc> heard() {
    std::vector<DecodedOsc> all;
    for (auto datagrams = socket_.receive(); !datagrams.empty(); datagrams = socket_.receive())
      for (const auto& datagram : datagrams)
        for (auto& message : decode_osc(datagram.bytes)) all.push_back(std::move(message));
    return all;
  }
  static std::vector<DecodedOsc> only(const std::vector<DecodedOsc>& all, const char* address) {
    std::vector<DecodedOsc> some;
    for (const DecodedOsc& message : all)
      if (message.address == address) some.push_back(message);
    return some;
  }

  UdpSocket socket_ = *UdpSocket::bind(Address::loopback(0));
  std::unique_ptr<PoseConsumer> consumer_;
};

TEST_F(OscConsumers, SendAVmcFrameInTheCallThatBringsThePose) {
  open("vmc");
  consumer_->on_skeleton(kOscAlice, average_skeleton(1.5f), osc_time(0));
  Hands hands;
  hands.presence = 1;
  hands.R_PB[0] = Eigen::Quaternionf(0.8f, 0.6f, 0.0f, 0.0f);
  consumer_->on_hands(kOscAlice, hands, osc_time(0));
  dance(kOscAlice, 0);
  const auto all = heard();
  EXPECT_EQ(only(all, "/VMC/Ext/Bone/Pos").size(), 55u);
  ASSERT_EQ(only(all, "/VMC/Ext/VRM").size(), 1u);
  EXPECT_EQ(only(all, "/VMC/Ext/VRM")[0].texts, (std::vector<std::string>{"", "alice"}));
  for (const DecodedOsc& bone : only(all, "/VMC/Ext/Bone/Pos")) {
    if (bone.texts[0] == "LeftLowerLeg") {
      EXPECT_FLOAT_EQ(bone.floats[1], average_skeleton(1.5f).offset(Bone::kLeftLowerLeg).y());
    }
    if (bone.texts[0] == "LeftThumbProximal") {
      EXPECT_FLOAT_EQ(bone.floats[3], 0.6f);
    }
  }
}

TEST_F(OscConsumers, FingersThatNoLongerComeAreNotSentOn) {
  open("vmc");
  Hands hands;
  hands.presence = 1;
  hands.R_PB[0] = Eigen::Quaternionf(0.8f, 0.6f, 0.0f, 0.0f);
  const auto thumb_x = [&] {
    for (const DecodedOsc& bone : only(heard(), "/VMC/Ext/Bone/Pos"))
      if (bone.texts[0] == "LeftThumbProximal") return bone.floats[3];
    return 0.0f;
  };
  consumer_->on_hands(kOscAlice, hands, osc_time(0));
  dance(kOscAlice, 0);
  EXPECT_FLOAT_EQ(thumb_x(), 0.6f);
  dance(kOscAlice, 1900);
  EXPECT_FLOAT_EQ(thumb_x(), 0.6f);
  dance(kOscAlice, 2100);
  EXPECT_FLOAT_EQ(thumb_x(), 0.0f);
  consumer_->on_hands(kOscAlice, hands, osc_time(2200));
  dance(kOscAlice, 2200);
  EXPECT_FLOAT_EQ(thumb_x(), 0.6f);
  hands.presence = 0;
  consumer_->on_hands(kOscAlice, hands, osc_time(2210));
  dance(kOscAlice, 2220);
  EXPECT_FLOAT_EQ(thumb_x(), 0.0f);
}

TEST_F(OscConsumers, TellThatTheDancerIsSilentAndThatTheyAreBack) {
  open("vmc");
  consumer_->on_second(osc_time(0));
  auto states = only(heard(), "/VMC/Ext/OK");
  ASSERT_EQ(states.size(), 1u);
  EXPECT_EQ(states[0].ints, (std::vector<int>{0, 0, 0, 0}));  // nobody yet
  dance(kOscAlice, 100);
  consumer_->on_second(osc_time(1000));
  states = only(heard(), "/VMC/Ext/OK");
  ASSERT_EQ(states.size(), 1u);
  EXPECT_EQ(states[0].ints, (std::vector<int>{1, 3, 0, 1}));
  consumer_->on_second(osc_time(2000));
  consumer_->on_second(osc_time(3000));
  const auto in_silence = heard();
  states = only(in_silence, "/VMC/Ext/OK");
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(states[1].ints, (std::vector<int>{1, 3, 0, 0}));
  EXPECT_EQ(in_silence.size(), 4u);  // and the time
  dance(kOscAlice, 3100);
  const auto back = heard();
  EXPECT_EQ(only(back, "/VMC/Ext/OK")[0].ints, (std::vector<int>{1, 3, 0, 1}));
  EXPECT_NEAR(only(back, "/VMC/Ext/T")[0].floats[0], 3.0f, 1e-4f);
  EXPECT_NE(consumer_->summary().find("silent 1 times"), std::string::npos) << consumer_->summary();
  ASSERT_TRUE(consumer_->finish().has_value());
  EXPECT_EQ(only(heard(), "/VMC/Ext/OK")[0].ints, (std::vector<int>{1, 3, 0, 0}));
}

TEST_F(OscConsumers, SendOneGuestTheOneAskedForOrTheFirst) {
  for (const char* name : {"vmc", "vrchat"}) {
    open(name);
    dance(kOscBob, 0);
    heard();
    dance(kOscAlice, 10);
    EXPECT_TRUE(heard().empty()) << name;
    EXPECT_NE(consumer_->summary().find("1 poses of other guests left out"), std::string::npos)
        << consumer_->summary();
    ConsumerOptions options;
    options.guest = kOscAlice;
    open(name, options);
    dance(kOscBob, 20);
    EXPECT_TRUE(heard().empty()) << name;
    dance(kOscAlice, 30);
    EXPECT_FALSE(heard().empty()) << name;
  }
}

TEST_F(OscConsumers, KeepTheRateByCaptureTime) {
  ConsumerOptions options;
  options.hz = 30.0;
  for (const char* name : {"vmc", "vrchat"}) {
    open(name, options);
    for (int i = 0; i < 120; ++i) dance(kOscAlice, i * 1000 / 120);
    const auto frames = only(
        heard(), name == std::string("vmc") ? "/VMC/Ext/T" : "/tracking/trackers/head/position");
    EXPECT_NEAR(static_cast<double>(frames.size()), 30.0, 1.0) << name;
  }
}

TEST_F(OscConsumers, KeepTimeRunningOnWhenADancerComesOfAnotherClock) {
  open("vmc");
  dance(kOscAlice, 0);
  dance(kOscAlice, 500);
  Pose pose;
  pose.clock_id = 2;
  pose.capture_time = MonoTime::from_us(77);
  consumer_->on_pose(kOscAlice, pose, osc_time(525));
  pose.capture_time += Duration::ms(20);
  consumer_->on_pose(kOscAlice, pose, osc_time(545));
  const auto times = only(heard(), "/VMC/Ext/T");
  ASSERT_EQ(times.size(), 4u);
  EXPECT_NEAR(times[1].floats[0], 0.5f, 1e-4f);
  EXPECT_NEAR(times[2].floats[0], 0.52f, 1e-4f);
  EXPECT_NEAR(times[3].floats[0], 0.54f, 1e-4f);
}

TEST_F(OscConsumers, SendVrchatItsTrackersInOnePacket) {
  open("vrchat");
  consumer_->on_skeleton(kOscAlice, average_skeleton(1.5f), osc_time(0));
  dance(kOscAlice, 0);
  const auto packets = socket_.receive();
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(decode_osc(packets[0].bytes).size(), 18u);
  for (const DecodedOsc& message : decode_osc(packets[0].bytes))
    EXPECT_TRUE(message.address.starts_with("/tracking/trackers/")) << message.address;
}

TEST_F(OscConsumers, AllocateNothingPerPose) {
  for (const char* name : {"vmc", "vrchat"}) {
    open(name);
    const AllocationGuard guard;
    for (int i = 0; i < 50; ++i) {
      consumer_->on_skeleton(kOscAlice, average_skeleton(), osc_time(i));
      consumer_->on_hands(kOscAlice, Hands(), osc_time(i));
      dance(kOscAlice, i * 20);
      consumer_->on_second(osc_time(i * 20));
    }
    EXPECT_EQ(guard.allocations(), 0u) << name;
  }
}

TEST_F(OscConsumers, GoOnWhereNobodyListensAndSaySo) {
  ConsumerOptions options;
  options.address = "127.0.0.1:" + std::to_string(*free_loopback_port());
  consumer_ = *make_consumer("vmc", options);
  for (int i = 0; i < 5; ++i) dance(kOscAlice, i * 20);
  EXPECT_NE(consumer_->summary().find("refused, as no program listens there"), std::string::npos)
      << consumer_->summary();
  options.address = "no.such.host.invalid:39539";
  EXPECT_FALSE(make_consumer("vmc", options).has_value());
}

}  // namespace
}  // namespace dance
