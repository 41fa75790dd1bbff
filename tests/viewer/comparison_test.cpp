#include "viewer/scene/comparison.h"

#include <gtest/gtest.h>

#include "core/base/raw_twin.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

SceneState scene_of_names(std::initializer_list<const char*> names) {
  SceneState scene;
  for (const char* name : names) {
    SceneGuest guest;
    guest.id = *GuestId::parse(name);
    guest.pose.p_WH_m.x() = static_cast<float>(scene.guests.size());
    scene.guests.push_back(guest);
  }
  return scene;
}

std::string names_in(const SceneState& scene) {
  std::string names;
  for (const SceneGuest& guest : scene.guests) names += std::string(guest.id.view()) + " ";
  return names;
}

TEST(Comparison, HasTheTwinOnOneSideAndItsDancerOnTheOther) {
  const SceneState scene = scene_of_names({"alice", "bob", "bob-raw"});
  ASSERT_TRUE(has_twins(scene));
  const Comparison both = compare(scene);
  EXPECT_EQ(names_in(both.raw), "alice bob ");
  EXPECT_EQ(names_in(both.shown), "alice bob ");
  EXPECT_EQ(both.raw.guests[1].pose.p_WH_m.x(), 2.0f);
  EXPECT_EQ(both.shown.guests[1].pose.p_WH_m.x(), 1.0f);
}

TEST(Comparison, TellsOfTheDancerWhoIsBehindMost) {
  SceneState scene = scene_of_names({"alice", "bob", "bob-raw", "carol", "carol-raw"});
  const auto shown_ms_ago = [&](std::size_t i, float ms) {
    scene.guests[i].figures.beat.emplace().delay_ms = ms;
  };
  shown_ms_ago(0, 700.0f);  // here: nobody to compare with
  shown_ms_ago(1, -2.0f);
  shown_ms_ago(2, 120.0f);
  shown_ms_ago(3, 420.0f);
  shown_ms_ago(4, 90.0f);
  Comparison both = compare(scene);
  for (const SceneState* half : {&both.raw, &both.shown})
    for (const SceneGuest& guest : half->guests)
      EXPECT_EQ(guest.is_compared, guest.id.view() == "bob") << guest.id.view();
  EXPECT_TRUE(both.shown.guests[1].is_predicted) << "newer than what has come";
  EXPECT_FALSE(both.raw.guests[1].is_predicted);
  EXPECT_FALSE(both.shown.guests[2].is_predicted) << "carol is shown late and true";
  shown_ms_ago(1, 410.0f);
  EXPECT_FALSE(compare(scene).shown.guests[1].is_predicted);
  shown_ms_ago(3, 0.0f);
  EXPECT_TRUE(compare(scene).shown.guests[2].is_predicted) << "and so is who is not compared";
}

TEST(Comparison, APlainPictureShowsNobodyTwice) {
  SceneState scene = scene_of_names({"alice", "bob", "bob-raw"});
  leave_out_twins(scene);
  EXPECT_EQ(names_in(scene), "alice bob ");
}

TEST(Comparison, LeavesTwinsOutInAnyOrder) {
  SceneState scene = scene_of_names({"bob-raw-raw", "bob-raw", "alice", "bob", "carol"});
  leave_out_twins(scene);
  EXPECT_EQ(names_in(scene), "alice bob carol ");
}

TEST(Comparison, APictureWithoutTwinsAllocatesNothing) {
  SceneState scene = scene_of_names({"alice", "bob", "carol"});
  const AllocationGuard guard;
  for (int picture = 0; picture < 10; ++picture) leave_out_twins(scene);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(scene.guests.size(), 3u);
}

TEST(Comparison, AllocatesNothingForTheGuestsOfThePictureBefore) {
  SceneState scene = scene_of_names({"alice", "bob", "carol"});
  scene.guests[1].arriving = scene.guests[1].staged = scene.guests[1].pose;
  Comparison both;
  compare(scene, both);
  const AllocationGuard guard;
  for (int picture = 0; picture < 10; ++picture) compare(scene, both);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(names_in(both.raw), "alice bob carol ");
}

TEST(Comparison, WhoIsMerelyCalledSoIsAGuestLikeOthers) {
  SceneState scene = scene_of_names({"alice", "sushi-raw"});
  EXPECT_FALSE(has_twins(scene));
  EXPECT_EQ(names_in(compare(scene).raw), "alice sushi-raw ");
  leave_out_twins(scene);
  EXPECT_EQ(names_in(scene), "alice sushi-raw ");
}

TEST(RawTwin, NamesGoBothWays) {
  const GuestId bob = *GuestId::parse("bob");
  ASSERT_TRUE(raw_twin_of(bob));
  EXPECT_EQ(raw_twin_of(bob)->view(), "bob-raw");
  EXPECT_EQ(twin_of_whom(*raw_twin_of(bob)), bob);
  EXPECT_FALSE(twin_of_whom(bob));
  EXPECT_FALSE(twin_of_whom(*GuestId::parse("-raw")));
  EXPECT_FALSE(raw_twin_of(*GuestId::parse("a-name-of-24-characters1"))) << "no room";
}

}  // namespace
}  // namespace dance
