// Hands that hold each other, as the viewer shows them: the poses that it draws of a dancer of this
// house and of one from elsewhere, with the routes of a session file between.
#include <gtest/gtest.h>

#include "house/house_port.h"
#include "manager/router.h"
#include "tests/core/bus/port_double.h"
#include "tests/transformers/touch/two_dancers.h"
#include "viewer/feed/guest_board.h"
#include "viewer/feed/stage_roster.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::uint64_t kHeldHandsClock = 5;

MonoTime picture_time(std::uint32_t number) { return touch_time(16 * number); }

Route route_of(Where from, std::vector<std::string> through) {
  Route route;
  route.from.where = from;
  route.to.where = Where::kStage;
  route.through = std::move(through);
  const bool is_plain = route.through.empty() || route.through.front() == "hold-hands";
  route.rate_hz = is_plain ? 0.0 : 60.0;
  return route;
}

// Who makes the lead's poses: the house's own process, which stages them before the bus has their
// captures, or a program beside it, whose captures come first.
enum class Lead { kBeside, kHosted };

// A house with its viewer, which hears the bus.
class HouseWithViewer : StageSink {
 public:
  explicit HouseWithViewer(const std::vector<Route>& routes, Lead lead = Lead::kBeside)
      : port_(bus_, {true, lead == Lead::kHosted ? std::vector<GuestId>{guest_named("lead")}
                                                 : std::vector<GuestId>{}}),
        lead_port_(lead == Lead::kHosted ? static_cast<SignalPort&>(port_) : bus_),
        router_(routes, kHeldHandsClock, *this) {
    for (const Where where : {Where::kCapture, Where::kGuest, Where::kStage})
      bus_.subscribe<Pose>(where, [this](const Channel& channel, const Pose& pose, MonoTime) {
        board_.on_pose(channel.where(), channel.guest(), pose, now_);
        if (channel.where() != Where::kGuest)
          order_ += channel.where() == Where::kStage ? 's' : 'c';
      });
    for (const Where where : {Where::kCapture, Where::kGuest})
      port_.subscribe<Pose>(where, [this](const Channel& channel, const Pose& pose, MonoTime) {
        if (has_stage) router_.take(channel.where(), channel.guest(), pose, now_);
      });
  }

  // A picture in which the palms of a dancer here and of one from elsewhere are so far apart.
  void dance(float gap_m, std::uint32_t number, MonoTime now) {
    const Pose lead = with_palm_at(lead_pose(), 0, meeting_place());
    const Pose follow =
        with_palm_at(follow_pose(), 1, meeting_place() + Vector3f(0.0f, gap_m, 0.0f));
    capture(guest_named("lead"), lead, number, now);
    port_.publish(Where::kGuest, guest_named("follow"), numbered(follow, number, now));
    router_.tick(1, now);
    draw(now);
  }
  void capture(const GuestId& who, const Pose& pose, std::uint32_t number, MonoTime now) {
    now_ = now;
    order_.clear();
    lead_port_.publish(Where::kCapture, who, numbered(pose, number, now - Duration::ms(3)));
    lead_order_ = order_;
  }
  void draw(MonoTime now) { roster_.update(now, scene_); }
  const SceneGuest& shown(const char* name) const {
    for (const SceneGuest& each : scene_.guests)
      if (each.id == guest_named(name)) return each;
    ADD_FAILURE() << name << " is not shown";
    static const SceneGuest kNobody;
    return kNobody;
  }
  float gap_m() const {
    return (palm_in(shown("lead").pose, 0) - palm_in(shown("follow").pose, 1)).norm();
  }
  const StageRoster& roster() const { return roster_; }
  // In which order the bus had the lead's last pose: c(apture), s(tage).
  const std::string& lead_order() const { return lead_order_; }

  bool has_stage = true;

 private:
  static Pose numbered(Pose pose, std::uint32_t number, MonoTime captured) {
    pose.sequence = number;
    pose.capture_time = captured;
    pose.clock_id = kHeldHandsClock;
    return pose;
  }
  void stage(const GuestId& who, Pose& pose, MonoTime now) override {
    pose.stamp(Hop::kStaged, now);
    port_.publish(Where::kStage, who, pose);
  }
  void stage(const GuestId&, const Hands&) override {}
  void stage(const GuestId&, const TimedSkeleton&) override {}

  PortDouble bus_;
  HousePort port_;
  SignalPort& lead_port_;
  Router router_;
  GuestBoard board_{kHeldHandsClock, false};
  StageRoster roster_{board_};
  SceneState scene_;
  MonoTime now_;
  std::string order_, lead_order_;
};

const std::vector<std::string> kFollow{"predict", "hold-hands"};

void dance_on(HouseWithViewer& house, float gap_m, std::uint32_t& number, std::uint32_t pictures) {
  for (const std::uint32_t end = number + pictures; number < end; ++number)
    house.dance(gap_m, number, picture_time(number));
}

class HeldHands : public ::testing::TestWithParam<Lead> {};
INSTANTIATE_TEST_SUITE_P(Leads, HeldHands, ::testing::Values(Lead::kBeside, Lead::kHosted),
                         [](const auto& lead) {
                           return lead.param == Lead::kHosted ? "Hosted" : "Beside";
                         });

TEST_P(HeldHands, MeetInThePicturesWhereBothRoutesHoldThem) {
  HouseWithViewer house(
      {route_of(Where::kCapture, {"hold-hands"}), route_of(Where::kGuest, kFollow)}, GetParam());
  std::uint32_t number = 1;
  dance_on(house, 0.0f, number, 5);
  dance_on(house, 0.06f, number, 60);
  EXPECT_LT(house.gap_m(), 0.01f);
  EXPECT_EQ(house.lead_order(), GetParam() == Lead::kHosted ? "sc" : "cs");
  // Each arm reaches half of the way: the own one is not the captured one.
  EXPECT_GT((palm_in(house.shown("lead").pose, 0) - meeting_place()).norm(), 0.02f);
}

TEST_P(HeldHands, MeetWhereOnlyOneOfTheRoutesHoldsThem) {
  for (const bool own_reaches : {false, true}) {
    HouseWithViewer house(
        {route_of(Where::kCapture, own_reaches ? std::vector<std::string>{"hold-hands"}
                                               : std::vector<std::string>{}),
         route_of(Where::kGuest, own_reaches ? std::vector<std::string>{"predict"} : kFollow)},
        GetParam());
    std::uint32_t number = 1;
    dance_on(house, 0.0f, number, 5);
    dance_on(house, 0.06f, number, 60);
    EXPECT_LT(house.gap_m(), 0.01f) << own_reaches;
  }
}

TEST_P(HeldHands, WithoutThemAnOwnDancerIsShownFromTheCaptureAndAtItsMoment) {
  HouseWithViewer house({route_of(Where::kCapture, {}), route_of(Where::kGuest, {"predict"})},
                        GetParam());
  std::uint32_t number = 1;
  dance_on(house, 0.06f, number, 60);
  const SceneGuest& lead = house.shown("lead");
  EXPECT_FALSE(lead.pose.stamped(Hop::kStaged).is_set()) << "by way of the stage";
  EXPECT_LT((palm_in(lead.pose, 0) - meeting_place()).norm(), 1e-4f);
}

TEST_P(HeldHands, AWordThatDelaysAnOwnDancerLeavesTheCapture) {
  HouseWithViewer house(
      {route_of(Where::kCapture, {"hold 50ms", "hold-hands"}), route_of(Where::kGuest, kFollow)},
      GetParam());
  std::uint32_t number = 1;
  dance_on(house, 0.06f, number, 60);
  EXPECT_FALSE(house.shown("lead").pose.stamped(Hop::kStaged).is_set());
}

TEST_P(HeldHands, ArmsThatLetGoAndAStageThatEndsLeaveTheCapture) {
  HouseWithViewer house(
      {route_of(Where::kCapture, {"hold-hands"}), route_of(Where::kGuest, kFollow)}, GetParam());
  std::uint32_t number = 1;
  dance_on(house, 0.06f, number, 60);
  EXPECT_TRUE(house.shown("lead").pose.stamped(Hop::kStaged).is_set());
  dance_on(house, 0.5f, number, 120);
  EXPECT_FALSE(house.shown("lead").pose.stamped(Hop::kStaged).is_set());

  dance_on(house, 0.03f, number, 60);
  EXPECT_TRUE(house.shown("lead").pose.stamped(Hop::kStaged).is_set());
  house.has_stage = false;
  for (const std::uint32_t end = number + 20; number < end; ++number)
    house.capture(guest_named("lead"), lead_pose(), number, picture_time(number));
  house.draw(picture_time(number));
  EXPECT_FALSE(house.shown("lead").pose.stamped(Hop::kStaged).is_set());
  EXPECT_EQ(house.shown("lead").pose.sequence, number - 1);
}

TEST_P(HeldHands, AnOwnDancersMomentIsTheCapturesByEitherWay) {
  HouseWithViewer house(
      {route_of(Where::kCapture, {"hold-hands"}), route_of(Where::kGuest, kFollow)}, GetParam());
  std::uint32_t number = 1;
  for (const float gap_m : {0.0f, 0.06f, 0.5f}) {
    dance_on(house, gap_m, number, 60);
    int told = 0;
    for (const StageRoster::Fresh& fresh : house.roster().fresh()) {
      if (fresh.guest != guest_named("lead")) continue;
      EXPECT_EQ(fresh.moment, fresh.pose.capture_time) << gap_m;
      ++told;
    }
    EXPECT_EQ(told, 1) << gap_m;
  }
}

TEST_P(HeldHands, NoPoseIsMissedWhereThePictureGoesOverToTheStage) {
  HouseWithViewer house(
      {route_of(Where::kCapture, {"hold-hands"}), route_of(Where::kGuest, kFollow)}, GetParam());
  bool goes_by_stage = false;
  int changes = 0;
  for (std::uint32_t number = 1; number < 200; ++number) {
    house.dance(number < 5 ? 0.0f : number < 80 ? 0.06f : 0.5f, number, picture_time(number));
    EXPECT_EQ(house.shown("lead").pose.sequence, number);
    const bool by_stage = house.shown("lead").pose.stamped(Hop::kStaged).is_set();
    changes += by_stage != std::exchange(goes_by_stage, by_stage) ? 1 : 0;
  }
  EXPECT_EQ(changes, 2) << "there and back";
}

}  // namespace
}  // namespace dance
