// What the Rokoko consumer sends, heard over the loopback device.
#include "consumers/rokoko/rokoko_consumer.h"

#include <gtest/gtest.h>

#include "core/net/mono_clock.h"
#include "formats/rokoko/rokoko_reader.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"

namespace dance {
namespace {

const GuestId kAna = GuestId::parse("ana").value();
const GuestId kBen = GuestId::parse("ben").value();

class RokokoStream : public testing::Test {
 protected:
  void SetUp() override {
    auto socket = UdpSocket::bind(Address::loopback(0), kLongDatagrams);
    ASSERT_TRUE(socket.has_value());
    socket_ = std::make_unique<UdpSocket>(std::move(*socket));
    open(RokokoConsumer::Dialect::kLz4, 1000.0);
  }
  void open(RokokoConsumer::Dialect dialect, double hz) {
    auto consumer = RokokoConsumer::open({socket_->local_address().to_string(), dialect, hz, 7});
    ASSERT_TRUE(consumer.has_value());
    consumer_ = std::move(*consumer);
  }
  void pose(const GuestId& guest, double ms, float x_m = 0.0f) {
    Pose pose = random_pose(random_);
    pose.clock_id = 7;
    pose.p_WH_m.x() = x_m;
    pose.capture_time = began_ + Duration::seconds(ms * 1e-3);
    consumer_->on_pose(guest, pose, pose.capture_time);
  }
  std::uint64_t frames() const { return consumer_->counters().frames; }
  // Reads all that came; the newest frame stays in the reader.
  std::size_t read() {
    std::size_t count = 0;
    for (auto batch = socket_->receive(); !batch.empty(); batch = socket_->receive())
      for (const auto& datagram : batch) {
        EXPECT_EQ(reader_.read(datagram.bytes), RokokoFault::kNone);
        longest_ = std::max(longest_, datagram.bytes.size());
        ++count;
      }
    return count;
  }

  std::unique_ptr<UdpSocket> socket_;
  std::unique_ptr<RokokoConsumer> consumer_;
  Random random_{8};
  RokokoReader reader_;
  std::size_t longest_ = 0;
  MonoTime began_ = mono_now();
};

TEST_F(RokokoStream, APoseOfOneDancerIsSentAtOnce) {
  for (int i = 0; i < 10; ++i) {
    pose(kAna, 16.0 * i);
    EXPECT_EQ(frames(), static_cast<std::uint64_t>(i) + 1);
  }
  EXPECT_EQ(read(), 10u);
  EXPECT_EQ(reader_.frame().actors.size(), 1u);
  EXPECT_NEAR(reader_.frame().timestamp_s, 0.144, 1e-6);
  EXPECT_EQ(reader_.frame().actors[0].name.view(), "ana");
}

TEST_F(RokokoStream, DancersWhoComeTogetherShareAFrameThatIsSentWithTheLast) {
  pose(kAna, 0.0);
  pose(kBen, 0.1);
  const std::uint64_t begun = frames();
  for (int i = 1; i <= 20; ++i) {
    pose(kAna, 16.0 * i, 1.0f);
    EXPECT_EQ(frames(), begun + static_cast<std::uint64_t>(i) - 1);
    pose(kBen, 16.0 * i + 0.1, -1.0f);
    EXPECT_EQ(frames(), begun + static_cast<std::uint64_t>(i));
  }
  read();
  ASSERT_EQ(reader_.frame().actors.size(), 2u);
  EXPECT_NEAR(reader_.frame().actors[0].joint(RokokoBody::kHip).position.x(), -1.0f, 1e-5f);
  EXPECT_NEAR(reader_.frame().actors[1].joint(RokokoBody::kHip).position.x(), 1.0f, 1e-5f);
}

TEST_F(RokokoStream, DancersWhoComeAtOtherTimesCauseAFrameEach) {
  for (int i = 0; i < 10; ++i) {
    pose(kAna, 16.0 * i);
    EXPECT_EQ(frames(), 2u * static_cast<std::uint64_t>(i) + 1);
    pose(kBen, 16.0 * i + 8.0);
    EXPECT_EQ(frames(), 2u * static_cast<std::uint64_t>(i) + 2);
  }
}

TEST_F(RokokoStream, WhenAPartnerFallsSilentTheOtherIsNotHeldUp) {
  for (int i = 0; i < 3; ++i) {
    pose(kAna, 16.0 * i);
    pose(kBen, 16.0 * i + 0.1);
  }
  const std::uint64_t before = frames();
  pose(kAna, 48.0);  // waits for ben, who came with her last time
  EXPECT_EQ(frames(), before);
  pose(kAna, 64.0);  // what waited goes first; ben no longer keeps pace
  EXPECT_EQ(frames(), before + 2);
  pose(kAna, 80.0);
  EXPECT_EQ(frames(), before + 3);
}

TEST_F(RokokoStream, WhoHasGoneLeavesTheScene) {
  pose(kAna, 0.0);
  pose(kBen, 8.0);
  pose(kBen, 2500.0);
  consumer_->on_second(began_ + Duration::ms(2600));
  pose(kBen, 2616.0);
  read();
  ASSERT_EQ(reader_.frame().actors.size(), 1u);
  EXPECT_EQ(reader_.frame().actors[0].name.view(), "ben");
  pose(kAna, 2700.0);
  read();
  EXPECT_EQ(reader_.frame().actors.size(), 2u);
}

TEST_F(RokokoStream, GlovesAreOnWhileHandsCome) {
  Hands hands;
  hands.presence = 1;
  pose(kAna, 0.0);
  read();
  EXPECT_FALSE(reader_.frame().actors[0].has_left_glove);
  consumer_->on_hands(kAna, hands, began_ + Duration::ms(10));
  pose(kAna, 16.0);
  read();
  EXPECT_TRUE(reader_.frame().actors[0].has_left_glove);
  EXPECT_TRUE(reader_.frame().actors[0].present.all());
  pose(kAna, 2900.0);
  consumer_->on_second(began_ + Duration::ms(3000));
  pose(kAna, 3016.0);
  read();
  EXPECT_FALSE(reader_.frame().actors[0].has_left_glove);
}

TEST_F(RokokoStream, TheRateIsKeptOnAverage) {
  open(RokokoConsumer::Dialect::kLz4, 30.0);
  for (int i = 0; i < 300; ++i) pose(kAna, 10.0 * i);
  EXPECT_NEAR(static_cast<double>(frames()), 91.0, 4.0);
  EXPECT_EQ(frames() + consumer_->counters().throttled, 300u);
  read();
  EXPECT_EQ(reader_.frame().fps, 30.0);
}

// Sixteen with both hands: 160 kB of text.
TEST_F(RokokoStream, ActorsWithoutRoomAreLeftOutAndCounted) {
  for (const auto dialect : {RokokoConsumer::Dialect::kLz4, RokokoConsumer::Dialect::kJson}) {
    open(dialect, 1000.0);
    Hands hands;
    hands.presence = 1;
    for (auto& rotation : hands.R_PB) rotation = random_rotation(random_);
    std::vector<GuestId> guests;
    for (std::size_t i = 0; i < RokokoFrame::kMostActors; ++i)
      guests.push_back(*GuestId::parse("guest-" + std::to_string(i)));
    for (int round = 0; round < 3; ++round)
      for (std::size_t i = 0; i < guests.size(); ++i) {
        consumer_->on_hands(guests[i], hands, began_ + Duration::ms(100 * round));
        pose(guests[i], 100.0 * round + 0.01 * static_cast<double>(i), 0.1f * float(i));
      }
    EXPECT_GT(consumer_->counters().left_out, 0u);
    longest_ = 0;
    EXPECT_GT(read(), 0u);
    const bool packs = dialect == RokokoConsumer::Dialect::kLz4;
    EXPECT_LE(longest_, packs ? RokokoConsumer::kMostLz4Bytes : RokokoConsumer::kMostJsonBytes);
    EXPECT_GE(reader_.frame().actors.size(), 6u);
    EXPECT_LT(reader_.frame().actors.size(), RokokoFrame::kMostActors);
    EXPECT_NE(consumer_->summary().find("actors left out"), std::string::npos);
    consumer_->on_pose(kBen, Pose(), began_ + Duration::ms(301));
    EXPECT_EQ(consumer_->counters().guests_too_many, 1u);
  }
}

TEST_F(RokokoStream, APoseIsSentWithoutAllocating) {
  pose(kAna, 0.0);
  pose(kBen, 0.1);
  const AllocationGuard guard;
  for (int i = 1; i < 20; ++i) {
    pose(kAna, 16.0 * i);
    pose(kBen, 16.0 * i + 0.1);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
