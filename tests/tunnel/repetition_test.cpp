// Poses that go once more where a way loses some.
#include "tunnel/session/repetition.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

class RepetitionTest : public ::testing::Test {
 protected:
  struct Counts {
    std::uint64_t sent = 0;      // by alice
    std::size_t heard = 0;       // of alice by bob, each once
    std::uint64_t up_bytes = 0;  // of alice's house
  };

  void begin(bool repeats, double loss_up, double loss_down) {
    tunnel = std::make_unique<SimulatedTunnel>(ServerLimits{.repeats = repeats});
    a = &tunnel->add_house("salsa", {"alice"});
    b = &tunnel->add_house("salsa", {"bob"});
    tunnel->run(Duration::ms(300));
    tunnel->on_datagram = [=, this](bool to_server, PeerId, wire::Bytes) {
      return static_cast<double>(random.next_u64() % 100'000) >=
             (to_server ? loss_up : loss_down) * 1e5;
    };
  }

  Counts dance_for(Duration span) {
    const std::uint64_t sent = a->link->counters().poses_sent;
    const std::uint64_t bytes = a->link->counters().bytes_out;
    b->poses.clear();
    Dance{*tunnel, {{a, guest("alice")}, {b, guest("bob")}}}.run(span);
    std::set<std::uint32_t> heard;
    std::uint32_t newest = 0;
    for (const auto& pose : b->poses) {
      EXPECT_GT(pose.pose.sequence, newest) << "never an older one after a newer one";
      newest = pose.pose.sequence;
      heard.insert(newest);
    }
    return {a->link->counters().poses_sent - sent, heard.size(),
            a->link->counters().bytes_out - bytes};
  }
  static double lost(const Counts& c) {
    return 1.0 - static_cast<double>(c.heard) / static_cast<double>(c.sent);
  }

  Random random{41};
  std::unique_ptr<SimulatedTunnel> tunnel;
  SimulatedTunnel::House* a = nullptr;
  SimulatedTunnel::House* b = nullptr;
};

TEST_F(RepetitionTest, LeavesLittleOfWhatAWayLoses) {
  for (const double loss : {0.01, 0.03, 0.05}) {
    begin(false, loss, loss);
    dance_for(Duration::s(30));
    const Counts once = dance_for(Duration::s(120));
    begin(true, loss, loss);
    dance_for(Duration::s(30));
    const Counts twice = dance_for(Duration::s(120));
    EXPECT_GT(lost(once), 1.5 * loss) << "two ways";
    // Independent losses: two of one pose on either way, and what then does not decode.
    EXPECT_LT(lost(twice), 0.2 * lost(once)) << loss;
    EXPECT_LT(lost(twice), 0.01);
    EXPECT_GT(a->link->counters().poses_repeated, 0u);
    EXPECT_GT(tunnel->server().counters().records_repeated, 0u);
  }
}

TEST_F(RepetitionTest, CostsNothingWhereNothingIsLost) {
  begin(true, 0.0, 0.0);
  dance_for(Duration::s(60));
  EXPECT_EQ(a->link->counters().poses_repeated, 0u);
  EXPECT_EQ(tunnel->server().counters().records_repeated, 0u);
  EXPECT_EQ(tunnel->server().counters().of(ServerReject::kDuplicate), 0u);
}

TEST_F(RepetitionTest, IsForTheWayThatLoses) {
  begin(true, 0.04, 0.0);
  dance_for(Duration::s(20));
  EXPECT_GT(a->link->counters().poses_repeated, 0u);
  EXPECT_EQ(tunnel->server().counters().records_repeated, 0u);
  begin(true, 0.0, 0.04);
  dance_for(Duration::s(20));
  EXPECT_EQ(a->link->counters().poses_repeated, 0u);
  EXPECT_GT(tunnel->server().counters().records_repeated, 0u);
  // Who has them already takes no notice.
  EXPECT_EQ(b->link->counters().late, 0u);
}

TEST_F(RepetitionTest, EndsWhenTheWayIsWellAgain) {
  begin(true, 0.03, 0.03);
  dance_for(Duration::s(20));
  ASSERT_GT(a->link->counters().poses_repeated, 0u);
  tunnel->on_datagram = {};
  dance_for(Duration::s(120));
  const std::uint64_t repeated = a->link->counters().poses_repeated;
  const std::uint64_t by_server = tunnel->server().counters().records_repeated;
  dance_for(Duration::s(10));
  EXPECT_EQ(a->link->counters().poses_repeated, repeated);
  EXPECT_EQ(tunnel->server().counters().records_repeated, by_server);
}

TEST(Repetition, BeginsWithWhatWasSeenAndNotWithAGuess) {
  LossMeter meter;
  Repetition repetition;
  ASSERT_GT(meter.loss(), 0.005f);
  repetition.update(meter);
  EXPECT_FALSE(repetition.is_on());
  for (int i = 0; i < 100; ++i) meter.add(i % 20 == 0);
  repetition.update(meter);
  EXPECT_TRUE(repetition.is_on());
  EXPECT_FLOAT_EQ(repetition.residual(meter), meter.in_a_row());
}

}  // namespace
}  // namespace dance
