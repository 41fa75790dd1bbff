// A receiver of NatNet with packets of a server over the loopback device.
#include "producers/natnet/natnet_receiver.h"

#include <gtest/gtest.h>

#include "core/net/mono_clock.h"
#include "core/pose/kinematics.h"
#include "producers/rokoko/rokoko_body.h"
#include "tests/formats/natnet/natnet_figure.h"
#include "tests/formats/natnet/natnet_packets.h"
#include "tests/formats/rokoko/rokoko_couple.h"
#include "tests/producers/rokoko/pose_log_sink.h"

namespace dance {
namespace {

constexpr NatNetVersion kVersions[] = {{3, 0}, {3, 1}, {4, 0}, {4, 1}};
const GuestId kAna = GuestId::parse("ana").value();

// Two joints for the trunk, as Motive has.
FigureFrame figure_at(SalsaDancer& dancer, double seconds) {
  Pose pose;
  dancer.dance_at(Duration::seconds(seconds), pose);
  RokokoActor actor;
  make_rokoko_actor(dancer.skeleton(), pose, nullptr, actor);
  return figure_of(actor);
}

// What a bone's place and rotation become where Motive's Z axis points up.
FigureFrame with_z_up(FigureFrame figure) {
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Eigen::Vector3f p = figure.p_WB_m[b];
    figure.p_WB_m[b] = {p.x(), -p.z(), p.y()};
    const Eigen::Quaternionf R = figure.R_WB[b];
    figure.R_WB[b] = Eigen::Quaternionf(R.w(), R.x(), -R.z(), R.y());
  }
  return figure;
}

class NatNetStream : public testing::Test {
 protected:
  void SetUp() override { poller_ = std::move(*Poller::create()); }
  void open(const std::string& more = "", const std::string& actor = "") {
    sink_ = PoseLogSink();
    receiver_.reset();
    const std::string address = "127.0.0.1:" + std::to_string(*free_loopback_port());
    auto opened = NatNetReceiver::open({kAna, address + more, actor}, sink_, *poller_);
    ASSERT_TRUE(opened.has_value()) << opened.error().what;
    receiver_ = std::move(*opened);
  }
  void take(const std::vector<std::uint8_t>& packet, double seconds = 0.0,
            const Address& from = Address::loopback(1510)) {
    const MonoTime at = began_ + Duration::seconds(seconds);
    receiver_->take(from, packet, at, at);
  }
  void describe(NatNetVersion version, const FigureFrame& figure) {
    auto models = std::make_unique<NatNetModels>();
    (void)models->skeletons.try_push(natnet_model(figure, "Ana", 3));
    (void)models->skeletons.try_push(natnet_model(figure, "Ben", 5, NatNetNames::kFbx));
    take(natnet_server_packet(version, 1'000'000));
    take(natnet_models_packet(version, *models));
  }
  std::vector<std::uint8_t> frame_packet(NatNetVersion version, const FigureFrame& figure,
                                         double seconds, bool in_parents, std::int32_t id = 3) {
    auto frame = std::make_unique<NatNetFrame>();
    frame->exposed_ticks = 5'000'000 + static_cast<std::uint64_t>(seconds * 1e6);
    (void)frame->skeletons.try_push(natnet_skeleton(figure, id, in_parents));
    return natnet_frame_packet(version, *frame);
  }
  float worst_m(const FigureFrame& wanted) {
    BodyFrames frames;
    forward_kinematics(sink_.skeleton, sink_.poses.back(), frames);
    float worst = 0.0f;
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if (wanted.has(static_cast<Bone>(b)))
        worst = std::max(worst, (frames.p_WB_m[b] - wanted.p_WB_m[b]).norm());
    return worst;
  }

  std::unique_ptr<Poller> poller_;
  PoseLogSink sink_;
  std::unique_ptr<NatNetReceiver> receiver_;
  MonoTime began_ = mono_now();
};

TEST_F(NatNetStream, ADanceGoesThroughInEachVersionWithGlobalBonesAndBonesInTheirParents) {
  for (const NatNetVersion version : kVersions) {
    for (const bool in_parents : {false, true}) {
      open();
      SalsaDancer dancer = salsa_dancer(SalsaRole::kFollow);
      describe(version, figure_at(dancer, 0.0));
      for (int i = 0; i < 200; ++i) {
        const double seconds = 0.01 * i;
        const FigureFrame figure = figure_at(dancer, seconds);
        take(frame_packet(version, figure, seconds, in_parents), seconds);
        ASSERT_EQ(sink_.poses.size(), static_cast<std::size_t>(i) + 1) << receiver_->summary();
        ASSERT_LT(worst_m(figure), 1e-4f) << "frame " << i << (in_parents ? " in parents" : "");
        EXPECT_NEAR((sink_.poses.back().capture_time - began_).as_seconds(), seconds, 1e-5);
      }
    }
  }
}

TEST_F(NatNetStream, WithZUpTheDancerStandsUpright) {
  open("?up=z");
  SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
  const FigureFrame figure = figure_at(dancer, 1.0);
  describe({3, 1}, with_z_up(figure));
  take(frame_packet({3, 1}, with_z_up(figure), 0.0, false));
  ASSERT_EQ(sink_.poses.size(), 1u);
  EXPECT_LT(worst_m(figure), 1e-4f);
}

TEST_F(NatNetStream, TheSkeletonThatIsAskedForIsTaken) {
  open("", "Ben");
  SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
  const FigureFrame figure = figure_at(dancer, 1.0);
  describe({4, 1}, figure);
  take(frame_packet({4, 1}, figure, 0.0, false, 3));
  EXPECT_EQ(sink_.poses.size(), 0u);
  EXPECT_EQ(receiver_->counters().without_actor, 1u);
  take(frame_packet({4, 1}, figure, 0.1, false, 5), 0.1);
  EXPECT_EQ(sink_.poses.size(), 1u);
}

TEST_F(NatNetStream, WithoutVersionOrNamesFramesAreCounted) {
  open();
  SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
  const FigureFrame figure = figure_at(dancer, 1.0);
  take(frame_packet({3, 1}, figure, 0.0, false));
  EXPECT_EQ(receiver_->counters().before_version, 1u);
  take(natnet_server_packet({3, 1}));
  take(frame_packet({3, 1}, figure, 0.1, false), 0.1);
  EXPECT_EQ(receiver_->counters().before_models, 1u);
  EXPECT_EQ(sink_.poses.size(), 0u);
  EXPECT_NE(receiver_->summary().find("give version=4.1"), std::string::npos);
}

TEST_F(NatNetStream, RigidBodiesAloneAreRefusedWithTheCure) {
  open("?version=4.0");
  auto frame = std::make_unique<NatNetFrame>();
  frame->rigid_bodies = 4;
  take(natnet_frame_packet({4, 0}, *frame));
  EXPECT_EQ(receiver_->counters().rigid_bodies_only, 1u);
  EXPECT_NE(receiver_->summary().find("switch Skeletons on"), std::string::npos);
}

TEST_F(NatNetStream, PacketsOfAnotherMachineAndDamagedOnesChangeNothing) {
  open();
  SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
  const FigureFrame figure = figure_at(dancer, 1.0);
  describe({3, 1}, figure);
  auto packet = frame_packet({3, 1}, figure, 0.0, false);
  take(packet, 0.0, *Address::resolve("127.0.0.2:1510"));
  EXPECT_EQ(receiver_->counters().of_others, 1u);
  for (std::size_t size = 0; size + 4 < packet.size(); size += 7)
    take({packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size)});
  EXPECT_EQ(sink_.poses.size(), 0u);
  EXPECT_GT(receiver_->counters().faults[static_cast<std::size_t>(NatNetFault::kTooShort)], 100u);
  take(packet, 0.1);
  EXPECT_EQ(sink_.poses.size(), 1u);
}

const Address kOtherMachine = *Address::resolve("127.0.0.2:1510");

TEST_F(NatNetStream, AMachineIsNoServerByAHeaderAlone) {
  open();
  SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
  const FigureFrame figure = figure_at(dancer, 1.0);
  for (int i = 0; i < 10; ++i) {
    take(NatNetPacketWriter().u32(1).packet(NatNetMessage::kFrame), 0.0, kOtherMachine);
    take(NatNetPacketWriter().u32(1).packet(NatNetMessage::kServerInfo), 0.0, kOtherMachine);
  }
  describe({3, 1}, figure);
  take(frame_packet({3, 1}, figure, 0.1, false), 0.1);
  EXPECT_EQ(sink_.poses.size(), 1u);
}

TEST_F(NatNetStream, AllThatWasLearntOfASilentServerIsForgotten) {
  open();
  SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
  const FigureFrame figure = figure_at(dancer, 1.0);
  describe({4, 1}, figure);
  for (int i = 0; i < 50; ++i) take(frame_packet({4, 1}, figure, 0.1 * i, false), 0.1 * i);
  ASSERT_EQ(sink_.poses.size(), 50u);
  take(frame_packet({3, 1}, figure, 6.0, false), 6.0, kOtherMachine);
  EXPECT_EQ(receiver_->counters().of_others, 1u);
  // Another machine, of another version, with another skeleton and other ticks.
  auto models = std::make_unique<NatNetModels>();
  (void)models->skeletons.try_push(natnet_model(figure, "Cleo", 8));
  take(frame_packet({3, 1}, figure, 7.5, false, 8), 7.5, kOtherMachine);
  EXPECT_EQ(receiver_->counters().before_version, 1u);
  take(natnet_server_packet({3, 1}, 2'000'000), 7.5, kOtherMachine);
  take(frame_packet({3, 1}, figure, 7.6, false, 3), 7.6, kOtherMachine);
  EXPECT_EQ(receiver_->counters().before_models, 1u);
  take(natnet_models_packet({3, 1}, *models), 7.6, kOtherMachine);
  take(frame_packet({3, 1}, figure, 7.7, false, 8), 7.7, kOtherMachine);
  ASSERT_EQ(sink_.poses.size(), 51u);
  EXPECT_EQ(sink_.poses.back().capture_time, began_ + Duration::seconds(7.7));
  EXPECT_EQ(receiver_->summary().find("jumps"), std::string::npos) << receiver_->summary();
}

TEST_F(NatNetStream, AServerThatComesBackAsAnotherIsLearntAnew) {
  open("?server=127.0.0.1");
  SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
  const FigureFrame figure = figure_at(dancer, 1.0);
  describe({4, 1}, figure);
  take(frame_packet({4, 1}, figure, 0.0, false), 0.0);
  ASSERT_EQ(sink_.poses.size(), 1u);
  take(natnet_server_packet({3, 1}, 10'000'000), 0.5);
  take(frame_packet({3, 1}, figure, 0.6, false), 0.6);
  EXPECT_EQ(receiver_->counters().before_models, 1u);
  EXPECT_EQ(sink_.poses.size(), 1u);
  auto models = std::make_unique<NatNetModels>();
  (void)models->skeletons.try_push(natnet_model(figure, "Ana", 3));
  take(natnet_models_packet({3, 1}, *models), 0.7);
  take(frame_packet({3, 1}, figure, 0.8, false), 0.8);
  EXPECT_EQ(sink_.poses.size(), 2u);
}

TEST_F(NatNetStream, AFloodIsReadABatchATurn) {
  const std::uint16_t port = *free_loopback_port();
  auto opened =
      NatNetReceiver::open({kAna, "127.0.0.1:" + std::to_string(port), ""}, sink_, *poller_);
  ASSERT_TRUE(opened.has_value()) << opened.error().what;
  auto sender = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(sender.has_value());
  const std::uint8_t junk[] = {7, 0, 9, 9};
  for (int i = 0; i < 20; ++i) sender->send_now(Address::loopback(port), junk);
  for (int i = 0; i < 20 && (*opened)->counters().packets == 0; ++i)
    poller_->run_once(Duration::ms(10));
  EXPECT_EQ((*opened)->counters().packets, 8u);
}

TEST_F(NatNetStream, AServerThatIsNamedIsAskedAndKeptAlive) {
  auto server = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(server.has_value());
  const std::string port = std::to_string(server->local_address().port());
  open("?server=127.0.0.1:" + port);
  std::vector<unsigned> asked;
  for (int i = 0; i < 100 && asked.size() < 3; ++i) {
    poller_->run_once(Duration::ms(10));
    for (const auto& datagram : server->receive())
      if (datagram.bytes.size() >= 4) asked.push_back(datagram.bytes[0]);
  }
  EXPECT_EQ(asked, (std::vector<unsigned>{0, 4, 10}));
}

TEST_F(NatNetStream, TwoReceiversShareAGroup) {
  const std::string group = "239.255.42.99:1511?interface=127.0.0.1&version=3.1";
  PoseLogSink sinks[2];
  std::vector<std::unique_ptr<NatNetReceiver>> receivers;
  for (PoseLogSink& sink : sinks) {
    auto opened = NatNetReceiver::open({kAna, group, ""}, sink, *poller_);
    ASSERT_TRUE(opened.has_value()) << opened.error().what;
    receivers.push_back(std::move(*opened));
  }
  auto server = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(server.has_value());
  SalsaDancer dancer = salsa_dancer(SalsaRole::kLead);
  const auto packet = frame_packet({3, 1}, figure_at(dancer, 0.0), 0.0, false);
  const auto all_heard = [&] {
    return receivers[0]->counters().packets > 0 && receivers[1]->counters().packets > 0;
  };
  for (int i = 0; i < 100 && !all_heard(); ++i) {
    server->send_now(*Address::resolve("239.255.42.99:1511"), packet);
    poller_->run_once(Duration::ms(10));
  }
  EXPECT_TRUE(all_heard());
}

}  // namespace
}  // namespace dance
