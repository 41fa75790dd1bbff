// The receiver on a real port, in a network of its own.
#include <gtest/gtest.h>

#include <thread>

#include "core/net/udp_socket.h"
#include "formats/osc/vmc_writer.h"
#include "producers/receive/receiver_table.h"
#include "tests/producers/receive/kept_captures.h"

namespace dance {
namespace {

class SocketSink : public OscPacketSink {
 public:
  explicit SocketSink(std::uint16_t port)
      : to_(Address::loopback(port)), socket_(*UdpSocket::connect(to_)) {}
  void on_packet(std::span<const std::uint8_t> packet) override { socket_.send_now(to_, packet); }

 private:
  Address to_;
  UdpSocket socket_;
};

class VmcReceiverTest : public testing::Test {
 protected:
  void SetUp() override {
    port_ = *free_loopback_port();
    options_.guest = *GuestId::parse("alice");
    options_.listen = "127.0.0.1:" + std::to_string(port_);
    poller_ = *Poller::create();
    auto opened = open_receiver("vmc", options_, kept_, *poller_);
    ASSERT_TRUE(opened.has_value()) << opened.error().what;
    receiver_ = std::move(*opened);
  }
  void turn_until(std::size_t poses) {
    for (int turn = 0; turn < 1000 && kept_.poses.size() < poses; ++turn)
      poller_->run_once(Duration::ms(5));
  }

  std::uint16_t port_ = 0;
  ReceiverOptions options_;
  KeptCaptures kept_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<PoseReceiver> receiver_;
};

TEST_F(VmcReceiverTest, TakesTheFirstPerformerAndCountsASecond) {
  SocketSink first(port_), second(port_);
  VmcWriter of_first(first, VmcDialect::kVrm0), of_second(second, VmcDialect::kVrm1);
  Pose pose;
  for (int i = 0; i < 20; ++i) {
    pose.p_WH_m.x() = 1.0f;
    of_first.write_pose(pose, nullptr, 0.02f * static_cast<float>(i));
    pose.p_WH_m.x() = 2.0f;
    of_second.write_pose(pose, nullptr, 0.02f * static_cast<float>(i));
    turn_until(static_cast<std::size_t>(i + 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  poller_->run_once(Duration::ms(50));
  EXPECT_GE(kept_.poses.size(), 19u);
  for (const Pose& each : kept_.poses) EXPECT_FLOAT_EQ(each.p_WH_m.x(), 1.0f);
  EXPECT_NE(receiver_->summary().find("packets of a second sender"), std::string::npos)
      << receiver_->summary();
}

TEST_F(VmcReceiverTest, TakesFramesOfOneLongPacketAsSlimeVrSendsThem) {
  // All packets of a frame in one: a bundle of bundles' elements.
  class Joined : public OscPacketSink {
   public:
    void on_packet(std::span<const std::uint8_t> packet) override {
      const std::size_t from = bytes.empty() ? 0 : 16;
      bytes.insert(bytes.end(), packet.begin() + static_cast<std::ptrdiff_t>(from), packet.end());
    }
    std::vector<std::uint8_t> bytes;
  } joined;
  VmcWriter writer(joined, VmcDialect::kVrm0);
  writer.write_pose(Pose(), nullptr, 0.0f);
  ASSERT_GT(joined.bytes.size(), 4000u);
  SocketSink sink(port_);
  sink.on_packet(joined.bytes);
  turn_until(1);
  ASSERT_EQ(kept_.poses.size(), 1u);
  EXPECT_EQ(kept_.poses[0].presence, kAllBones);
}

TEST_F(VmcReceiverTest, NamesAPortThatIsTakenAndTheCure) {
  const auto again = open_receiver("vmc", options_, kept_, *poller_);
  ASSERT_FALSE(again.has_value());
  EXPECT_NE(again.error().what.find("is taken"), std::string::npos) << again.error().what;
}

}  // namespace
}  // namespace dance
