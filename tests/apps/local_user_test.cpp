// Another user of the machine publishes on the bus of a house: captures of its guest, the removal
// of another guest, and requests not to receive that guest. The house accepts nothing of it.
#include <unistd.h>

#include "core/control/house_publisher.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr uid_t kAnotherUser = 65534;
constexpr float kForged_m = 7.0f;  // where the forged dancer stands
const GuestId kHost = *GuestId::parse("hanna");
const GuestId kVictim = *GuestId::parse("bob");

// Runs until it is killed. It ends each round with STATS/attacker.
int attack(const char* bus_url) {
  if (setgid(kAnotherUser) != 0 || setuid(kAnotherUser) != 0) return 3;
  auto bus = Bus::open(bus_url);
  if (!bus) return 4;
  Pose pose;
  pose.p_WH_m = {kForged_m, 1.0f, 0.0f};
  InterestWish interest{{}, this_clock_id(), 99, {}};
  interest.hidden[0] = kVictim;
  for (std::int32_t round = 1;; ++round) {
    const MonoTime now = mono_now();
    (*bus)->publish(Channel::of_house(Signal::kRemoval),
                    Removal{now, this_clock_id(), round, kVictim});
    interest.time = now;
    (*bus)->publish(Channel::of_house(Signal::kInterest), interest);
    (*bus)->publish(Channel::of_house(Signal::kHearing),
                    HearingWish{now, this_clock_id(), kHost, false, {}});
    pose.sequence = static_cast<std::uint32_t>(round);
    pose.capture_time = now;
    pose.clock_id = this_clock_id();
    (*bus)->publish(Where::kCapture, kHost, pose);
    Stats stats;
    stats.time = now;
    stats.clock_id = this_clock_id();
    (*bus)->publish(Channel::of_program(Signal::kStats, "attacker"), stats);
    usleep(20'000);
  }
}

class LocalUser : public BusPrograms {
 protected:
  void SetUp() override {
    if (geteuid() != 0) GTEST_SKIP() << "only root can run a process of another user";
    setenv("XDG_RUNTIME_DIR", folder_.path("run").c_str(), 1);
    setenv("XDG_CONFIG_HOME", folder_.path("config").c_str(), 1);
    std::filesystem::create_directories(folder_.path("run"));
    // First, while this process has one thread: it begins in a copy of it.
    auto started = ChildProcess::start_copy([] { return attack(kBus); });
    ASSERT_TRUE(started);
    attacker_ = std::make_unique<ChildProcess>(std::move(*started));
    auto poller = Poller::create();
    ASSERT_TRUE(poller);
    poller_ = std::move(*poller);
    for (const char* url : {kBus, kOtherBus}) {
      auto bus = Bus::open(url);
      ASSERT_TRUE(bus) << bus.error().what;
      poller_->watch((*bus)->fd(), [bus = bus->get()](MonoTime now) { bus->drain(now); });
      buses_.push_back(std::move(*bus));
    }
    buses_[0]->subscribe<Stats>(Where::kProgram,
                                [this](const Channel& channel, const Stats&, MonoTime) {
                                  rounds_ += channel.program() == "attacker" ? 1 : 0;
                                });
    buses_[0]->subscribe<Pose>({Where::kGuest, kVictim},
                               [this](const Channel&, const Pose&, MonoTime) { ++of_victim_; });
    buses_[1]->subscribe<Pose>(
        {Where::kGuest, kHost}, [this](const Channel&, const Pose& pose, MonoTime) {
          const bool is_forged = std::abs(pose.p_WH_m.x() - kForged_m) < 0.5f;
          ++(is_forged ? forged_ : genuine_);
        });
    start("dance-server", {});
    ASSERT_TRUE(wait_for([&] { return talk().find("hears on") != std::string::npos; })) << talk();
    ASSERT_TRUE(turn_until([&] { return rounds_ > 0; })) << "the other user reaches the bus";
  }
  template <class Condition>
  bool turn_until(const Condition& is_so) {
    return wait_for([&] {
      poller_->run_once(Duration::ms(20));
      return is_so();
    });
  }
  bool turn_for_rounds(int rounds) {
    const int end = rounds_ + rounds;
    return turn_until([&] { return rounds_ >= end; });
  }
  void invite(const char* guest, const char* role) {
    const Finished opened =
        run(bin("dance-server") + " --invite " + guest + " --role " + role +
            " --room salsa --address 127.0.0.1 | head -n 1 | " + bin("dance-key"));
    EXPECT_EQ(opened.exit_code, 0) << opened.talk;
  }
  // `dance link` beside the server needs no invitation.
  void start_link(const char* guest, const char* bus, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--guest", guest, "--room", "salsa", "--bus", bus});
    start("dance-link", std::move(more));
    ASSERT_TRUE(wait_for([&] { return is_in_room(guest); })) << talk();
  }
  bool is_in_room(const char* guest) const {
    return run(bin("dance-status") + " --once --json")
               .output.find("\"name\":\"" + std::string(guest) + "\"") != std::string::npos;
  }
  std::string talk() const { return text_of(folder_.path("talk")); }

  std::unique_ptr<ChildProcess> attacker_;
  std::unique_ptr<Poller> poller_;
  std::vector<std::unique_ptr<Bus>> buses_;
  int rounds_ = 0, of_victim_ = 0, forged_ = 0, genuine_ = 0;
};

TEST_F(LocalUser, RemovesNobodyAndHidesNobody) {
  invite("hanna", "host");
  invite("bob", "guest");
  start_link("hanna", kBus);
  start_link("bob", kOtherBus);
  start("dance-salsa", {"--guest", "bob", "--bus", kOtherBus});
  ASSERT_TRUE(turn_until([&] { return of_victim_ > 30; })) << talk();
  ASSERT_TRUE(turn_for_rounds(100));
  const int before = of_victim_;
  ASSERT_TRUE(turn_for_rounds(50));
  EXPECT_GT(of_victim_, before + 30) << "hidden, or removed";
  EXPECT_TRUE(is_in_room("bob")) << talk();
  // A program of the house's own user may.
  HousePublisher viewer(*buses_[0], kBus, *poller_);
  std::int32_t number = 1000;
  EXPECT_TRUE(turn_until([&] {
    viewer.publish(Channel::of_house(Signal::kRemoval),
                   Removal{mono_now(), this_clock_id(), ++number, kVictim});
    return !is_in_room("bob");
  })) << talk();
}

TEST_F(LocalUser, PosesOfAnotherUserAreNotSentAndTheOptionIsNamed) {
  start_link("bob", kOtherBus);
  start_link("hanna", kBus);
  ASSERT_TRUE(turn_until([&] { return talk().find("--bus-captures hanna") != std::string::npos; }))
      << talk();
  ASSERT_TRUE(turn_for_rounds(50));
  EXPECT_EQ(forged_, 0);
  // A producer of the house's own user needs no statement, and is not mixed with what is forged.
  start("dance-salsa", {"--guest", "hanna", "--bus", kBus});
  EXPECT_TRUE(turn_until([&] { return genuine_ > 60; })) << talk();
  EXPECT_EQ(forged_, 0);
}

TEST_F(LocalUser, PosesOfAnotherUserAreSentIfTheHouseAllowsIt) {
  start_link("bob", kOtherBus);
  start_link("hanna", kBus, {"--bus-captures", "hanna"});
  EXPECT_TRUE(turn_until([&] { return forged_ > 30; })) << talk();
}

}  // namespace
}  // namespace dance
