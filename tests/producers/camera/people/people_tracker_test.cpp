#include "producers/camera/people/people_tracker.h"

#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/producers/camera/people/crossing_couple.h"

namespace dance {
namespace {

constexpr double kFullyHidden = 0.7;

struct Tally {
  int frames = 0, right = 0, wrong = 0, missing = 0;
  int longest_wrong = 0;
};

// Who was taken for whom; the first is the one on the left.
Tally follow(CoupleScene& scene, PeopleTracker& tracker, std::size_t from = 0,
             std::size_t to = 1'000'000) {
  Tally tally;
  std::array<int, 2> wrong_run{};
  for (std::size_t f = from; f < std::min(to, scene.frames()); ++f) {
    scene.show(f);
    const auto people = tracker.update(scene, scene.time(f));
    for (std::size_t i = 0; i < 2; ++i) {
      const bool is_wrong = people[i].is_found && scene.nearer(f, people[i].body) != i;
      wrong_run[i] = is_wrong ? wrong_run[i] + 1 : 0;
      tally.longest_wrong = std::max(tally.longest_wrong, wrong_run[i]);
      if (scene.hidden(f, i) >= kFullyHidden) continue;
      ++tally.frames;
      ++(is_wrong ? tally.wrong : people[i].is_found ? tally.right : tally.missing);
    }
  }
  return tally;
}

TEST(PeopleTracker, KeepsEachWhoTheyAreWhileTheyCross) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    CoupleScene scene(crossing_couple(12.0), kCoupleHz, {}, {}, seed);
    PeopleTracker tracker({});
    const Tally tally = follow(scene, tracker);
    EXPECT_LE(tally.wrong, tally.frames / 100) << seed;
    EXPECT_LE(tally.longest_wrong, 15) << "longer than half a second";
    EXPECT_GE(tally.right, tally.frames * 9 / 10) << seed << ": " << tally.missing << " missing";
    // They were hidden, or this shows nothing.
    int hidden = 0;
    for (std::size_t f = 0; f < scene.frames(); ++f)
      hidden += scene.hidden(f, 1) >= kFullyHidden ? 1 : 0;
    EXPECT_GE(hidden, 3);
  }
}

TEST(PeopleTracker, InTheSameClothesPlaceAndSpeedDecide) {
  CoupleScene scene(crossing_couple(12.0, true), kCoupleHz, {}, {}, 1);
  PeopleTracker tracker({});
  const Tally tally = follow(scene, tracker);
  EXPECT_LE(tally.wrong, tally.frames / 20);
}

TEST(PeopleTracker, WhoWereTakenForEachOtherAreExchangedBackByTheirColours) {
  CoupleScene scene(crossing_couple(12.0), kCoupleHz, {}, {}, 1);
  PeopleTracker tracker({});
  follow(scene, tracker, 0, 45);
  // For a moment a camera shows them in each other's places, far apart.
  auto dancers = crossing_couple(12.0);
  std::swap(dancers[0].poses, dancers[1].poses);
  std::swap(dancers[0].skeleton, dancers[1].skeleton);
  CoupleScene exchanged(dancers, kCoupleHz, {}, {}, 1);
  std::size_t first_right = 0;
  for (std::size_t f = 45; f < 75 && first_right == 0; ++f) {
    exchanged.show(f);
    const auto people = tracker.update(exchanged, exchanged.time(f));
    if (people[0].is_found && exchanged.nearer(f, people[0].body) == 0 && people[1].is_found &&
        exchanged.nearer(f, people[1].body) == 1)
      first_right = f;
  }
  EXPECT_GT(first_right, 0u);
  EXPECT_LE(first_right, 45u + 15) << "half a second";
  EXPECT_EQ(tracker.counters().exchanged, 1u);
}

TEST(PeopleTracker, TheFirstAreNumberedFromTheLeft) {
  CoupleScene scene(crossing_couple(12.0), kCoupleHz, {}, {}, 4);
  scene.show(0);
  PeopleTracker tracker({});
  const auto people = tracker.update(scene, scene.time(0));
  ASSERT_TRUE(people[0].is_found && people[1].is_found);
  EXPECT_TRUE(people[0].is_new && people[1].is_new);
  EXPECT_LT(people[0].region.centre_x_px, people[1].region.centre_x_px);
}

TEST(PeopleTracker, OneWhoIsLeftOutOfAPictureIsStillKnown) {
  CoupleScene scene(crossing_couple(12.0), kCoupleHz, {}, {}, 1);
  PeopleTracker tracker({});
  scene.show(0);
  tracker.update(scene, scene.time(0));
  for (std::size_t f = 1; f < 31; ++f) {
    scene.show(f);
    const std::uint64_t before = tracker.counters().reads;
    const bool is_first = f % 2 == 0;
    const auto people = tracker.update(scene, scene.time(f), {is_first, !is_first, true, true});
    EXPECT_EQ(people[0].is_found, is_first) << f;
    EXPECT_EQ(people[1].is_found, !is_first) << f;
    EXPECT_FALSE(people[is_first ? 0 : 1].is_new) << f;
    EXPECT_EQ(tracker.counters().reads, before + 1) << f;
  }
}

TEST(PeopleTracker, ByTurnsNobodyBecomesTwo) {
  // The second is far out of the picture: only the first is there.
  auto dancers = crossing_couple(12.0);
  for (Pose& pose : dancers[1].poses) pose.p_WH_m.x() = 30.0f;
  SceneCamera camera;
  camera.middle_m = Eigen::Vector3d(0.0, 0.0, 0.0);
  CoupleScene scene(dancers, kCoupleHz, camera, {}, 1);
  PeopleTracker tracker({});
  for (std::size_t f = 0; f < 150; ++f) {
    scene.show(f);
    const bool is_first = f % 2 == 0;
    const auto people = tracker.update(scene, scene.time(f), {is_first, !is_first, true, true});
    if (f > 0 && people[is_first ? 0 : 1].is_found) {
      EXPECT_TRUE(is_first) << f;
    }
  }
  EXPECT_TRUE(tracker.track(0).was_ever_seen());
  EXPECT_FALSE(tracker.track(1).was_ever_seen());
}

TEST(PeopleTracker, WhoComesBackAfterLongIsKnownByTheClothes) {
  CoupleScene scene(crossing_couple(12.0), kCoupleHz, {}, {}, 1);
  PeopleTracker tracker({});
  follow(scene, tracker, 0, 40);
  // Twenty seconds later they have changed places, out of the picture.
  const std::size_t other_sides = scene.frames() / 2;
  scene.show(other_sides);
  const auto people = tracker.update(scene, scene.time(other_sides) + Duration::s(20));
  ASSERT_TRUE(people[0].is_found && people[1].is_found);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(scene.nearer(other_sides, people[i].body), i) << "by place it would be the other";
  EXPECT_GT(people[0].region.centre_x_px, people[1].region.centre_x_px);
}

TEST(PeopleTracker, OthersWhoComeAfterLongAreNumberedFromTheLeft) {
  CoupleScene scene(crossing_couple(12.0), kCoupleHz, {}, {}, 1);
  PeopleTracker tracker({});
  follow(scene, tracker, 0, 40);
  auto dancers = crossing_couple(12.0);
  dancers[0].clothes.fill(PictureColour(0.5f, 0.3f, 0.3f));
  dancers[1].clothes.fill(PictureColour(0.2f, 0.5f, 0.5f));
  CoupleScene others(dancers, kCoupleHz, {}, {}, 2);
  const std::size_t other_sides = others.frames() / 2;
  others.show(other_sides);
  const auto people = tracker.update(others, others.time(other_sides) + Duration::s(20));
  ASSERT_TRUE(people[0].is_found && people[1].is_found);
  EXPECT_LT(people[0].region.centre_x_px, people[1].region.centre_x_px);
}

TEST(PeopleTracker, ACameraThatWasUnpluggedShowsTheSame) {
  CoupleScene scene(crossing_couple(12.0), kCoupleHz, {}, {}, 1);
  PeopleTracker tracker({});
  follow(scene, tracker, 0, 40);
  tracker.lose_all();
  const std::size_t other_sides = scene.frames() / 2;
  scene.show(other_sides);
  const auto people = tracker.update(scene, scene.time(other_sides));
  ASSERT_TRUE(people[0].is_found && people[1].is_found);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(scene.nearer(other_sides, people[i].body), i);
}

TEST(PeopleTracker, WhatIsNoBodyHarmsNothing) {
  class Broken final : public PeopleVision {
   public:
    std::span<const SeenPerson> find(std::span<const SeenBody* const>) override {
      people_[0] = {0.9f, {std::nanf(""), 0.0f, 200.0f, 0.0f}};
      people_[1] = {0.9f, {1e30f, -1e30f, 1e30f, 1e9f}};
      people_[2] = {0.9f, {100.0f, 100.0f, 0.0f, 0.0f}};
      return people_;
    }
    bool read(const BodyRegion& region, const OtherPeople&, ReadBody& out) override {
      for (auto& p : out.body.image_px) p.setConstant(1e30f);
      for (auto& p : out.body.world_m) p.setConstant(-1e30f);
      out.body.visibility.fill(0.9f);
      out.body.presence = 0.9f;
      out.body.next_px = {Eigen::Vector2f(region.centre_x_px, 1e30f),
                          Eigen::Vector2f(0.0f, -1e30f)};
      return true;
    }
    std::optional<PictureColour> colour(const Eigen::Vector2f&) override { return std::nullopt; }
    std::array<SeenPerson, 3> people_;
  } broken;
  PeopleTracker tracker({4, 0.5f, {}, {}, {}});
  for (int i = 0; i < 200; ++i)
    EXPECT_EQ(tracker.update(broken, MonoTime() + Duration::ms(1000 + 33 * i)).size(), 4u);
}

TEST(PeopleTracker, AllocatesNothing) {
  CoupleScene scene(crossing_couple(12.0), kCoupleHz, {}, {}, 1);
  PeopleTracker tracker({});
  follow(scene, tracker, 0, 5);
  for (std::size_t f = 5; f < 60; ++f) {
    scene.show(f);
    const AllocationGuard guard;
    tracker.update(scene, scene.time(f));
    EXPECT_EQ(guard.allocations(), 0u) << f;
  }
}

}  // namespace
}  // namespace dance
