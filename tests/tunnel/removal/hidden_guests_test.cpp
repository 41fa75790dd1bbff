// A window hides a guest: the poses come over the line no more, until it shows the guest again or
// is heard of no longer.
#include "core/net/secure_random.h"
#include "tests/tunnel/removal/two_houses.h"

namespace dance {
namespace {

class HiddenGuests : public RemovalHouses {
 protected:
  void SetUp() override {
    RemovalHouses::SetUp();
    if (HasFatalFailure()) return;
    host_->viewer->subscribe<Pose>(Where::kGuest,
                                   [this](const Channel&, const Pose&, MonoTime) { ++heard_; });
    poller_->add_timer(mono_now(), [this](MonoTime now) {
      Pose pose;
      pose.sequence = ++danced_;
      pose.capture_time = now;
      pose.clock_id = this_clock_id();
      bob_->port->publish(Where::kCapture, named("bob"), pose);
      return now + Duration::ms(2);  // as fast as a server takes it
    });
  }
  // As a window says it: what it hides, and that it is there.
  void say() {
    wish_.time = mono_now();
    wish_.clock_id = this_clock_id();
    host_->port->publish(Channel::of_house(Signal::kInterest), wish_);
  }
  // And again, until is_there_ is false.
  void say_again_and_again() {
    is_there_ = true;
    say();
    poller_->add_timer(mono_now() + kAgain, [this](MonoTime now) {
      if (is_there_) say();
      if (is_there_ && hears_)
        host_->port->publish(Channel::of_house(Signal::kHearing),
                             HearingWish{mono_now(), this_clock_id(), named("hanna"), true, {}});
      return is_there_ ? now + kAgain : MonoTime();
    });
  }
  // What the server forwards while bob dances on.
  std::uint64_t forwarded_of(std::uint32_t poses) {
    const std::uint64_t before = server_->core().counters().records_out;
    const std::uint64_t in = server_->core().counters().records_in;
    EXPECT_TRUE(turn_until([&] { return server_->core().counters().records_in >= in + poses; }));
    return server_->core().counters().records_out - before;
  }
  // The time only ends a test that has failed.
  bool come_no_more() {
    const MonoTime given_up = mono_now() + Duration::s(30);
    while (forwarded_of(40) > 0)
      if (mono_now() > given_up) return false;
    return true;
  }
  bool come_again() {
    const std::uint64_t before = heard_;
    return turn_until([&] { return heard_ >= before + 20; });
  }

  static constexpr Duration kAgain = Duration::ms(100);

  bool is_there_ = false, hears_ = false;
  InterestWish wish_{{}, 0, secure_random_u64() | 1, {}};
  std::uint32_t danced_ = 0;
  std::uint64_t heard_ = 0;
};

TEST_F(HiddenGuests, CostTheLineNothingUntilTheyAreShownAgain) {
  ASSERT_TRUE(come_again());
  EXPECT_GE(forwarded_of(40), 30u);
  wish_.hidden[3] = named("bob");
  say_again_and_again();
  ASSERT_TRUE(come_no_more());
  const std::uint64_t heard = heard_;
  EXPECT_EQ(forwarded_of(100), 0u);
  EXPECT_EQ(heard_, heard);
  wish_.hidden[3] = GuestId();
  EXPECT_TRUE(come_again());
}

TEST_F(HiddenGuests, ComeBackWhenTheWindowHasDiedOrTheHouseHearsThem) {
  wish_.hidden[0] = named("bob");
  say_again_and_again();
  ASSERT_TRUE(come_no_more());
  // Servers send no voice of a guest of whom no pose is wanted.
  hears_ = true;
  const std::uint64_t heard = heard_;
  ASSERT_TRUE(turn_until([&] { return heard_ > heard; }));
  EXPECT_LE(forwarded_of(200), 20u);
  const std::uint64_t few = heard_;
  EXPECT_TRUE(turn_until([&] { return heard_ > few; })) << "seldom, and still";
  is_there_ = false;
  host_->link_bus->publish_second(mono_now() + InterestWishes::kHolds + Duration::s(1));
  EXPECT_TRUE(come_again()) << "as if nothing had been said for so long";
}

}  // namespace
}  // namespace dance
