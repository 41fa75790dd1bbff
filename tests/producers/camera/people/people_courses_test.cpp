// Bodies that a network takes for another's, and dancers whom only a search without the others
// finds.
#include <gtest/gtest.h>

#include "producers/camera/people/people_tracker.h"
#include "tests/producers/camera/people/crossing_couple.h"

namespace dance {
namespace {

// As the scene, but that the first region of a picture may show the other dancer, and that regions
// or searches may show nobody.
class MistakenVision final : public PeopleVision {
 public:
  explicit MistakenVision(CoupleScene& scene) : scene_(scene) {}

  void show(std::size_t frame) {
    scene_.show(frame);
    reads_ = 0;
  }
  std::span<const SeenPerson> find(std::span<const SeenBody* const> without) override {
    without_ = without.size();
    ++finds_;
    return scene_.find(without);
  }
  bool read(const BodyRegion& region, const OtherPeople& others, ReadBody& out) override {
    ++reads_;
    behind_ = std::max(behind_, others.behind.size());
    if (reads_ >= 2 && reads_ <= last_blind) return false;
    return scene_.read(reads_ == 1 && instead ? *instead : region, others, out);
  }
  std::optional<PictureColour> colour(const Eigen::Vector2f& place_px) override {
    return scene_.colour(place_px);
  }

  std::optional<BodyRegion> instead;  // of the first region
  int last_blind = 0;  // from the second read of a picture to this one nobody is seen
  int reads_ = 0, finds_ = 0;
  std::size_t behind_ = 0, without_ = 0;

 private:
  CoupleScene& scene_;
};

class PeopleCourses : public testing::Test {
 protected:
  // Up to where their regions come near each other.
  void approach() {
    for (frame_ = 0; frame_ < scene_.frames(); ++frame_) {
      vision_.show(frame_);
      tracker_.update(vision_, scene_.time(frame_));
      const BodyRegion &a = tracker_.track(0).region(), &b = tracker_.track(1).region();
      if (frame_ > 30 && (centre_of(a) - centre_of(b)).norm() < 0.16f * a.side_px) break;
    }
    ASSERT_LT(frame_, scene_.frames());
    ++frame_;
    vision_.show(frame_);
    // The nearer one is read first, where the other is.
    vision_.instead = tracker_.track(1).region();
  }
  std::span<const PersonInPicture> update() {
    return tracker_.update(vision_, scene_.time(frame_));
  }

  CoupleScene scene_{crossing_couple(12.0), kCoupleHz, {}, {}, 1};
  MistakenVision vision_{scene_};
  PeopleTracker tracker_{{}};
  std::size_t frame_ = 0;
};

TEST_F(PeopleCourses, TwoBodiesThatAreTakenForEachOtherAreGivenBackInTheSamePicture) {
  approach();
  const auto people = update();
  EXPECT_EQ(tracker_.counters().reassigned, 1u);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(people[i].is_found) << i;
    EXPECT_EQ(scene_.nearer(frame_, people[i].body), i);
    EXPECT_FALSE(people[i].is_new) << i;
  }
}

TEST_F(PeopleCourses, ABodyIsTheOthersWhoWasNotFoundAndItsOwnerIsLookedForAtOnce) {
  approach();
  vision_.last_blind = 2;
  const auto people = update();
  EXPECT_EQ(tracker_.counters().reassigned, 1u);
  ASSERT_TRUE(people[1].is_found);
  EXPECT_EQ(scene_.nearer(frame_, people[1].body), 1u);
  ASSERT_TRUE(people[0].is_found);
  EXPECT_EQ(scene_.nearer(frame_, people[0].body), 0u);
  EXPECT_EQ(vision_.reads_, 3);
}

TEST_F(PeopleCourses, WhoIsReadLaterIsTakenOutOfWhatIsSeenOfTheFirst) {
  approach();
  vision_.instead.reset();
  vision_.behind_ = 0;
  update();
  EXPECT_EQ(vision_.behind_, 1u);
}

TEST_F(PeopleCourses, OneWhoseClothesAreKnownIsSearchedForWithoutTheOthers) {
  vision_.show(0);
  update();
  EXPECT_EQ(vision_.without_, 0u) << "nobody is known yet";
  for (frame_ = 1; frame_ < 40; ++frame_) {
    vision_.show(frame_);
    update();
  }
  // The second is not seen in a picture, nor where that one is looked for.
  const int finds = vision_.finds_;
  vision_.show(frame_);
  vision_.last_blind = 3;
  vision_.instead.reset();
  while (frame_ < 60 && vision_.finds_ == finds) {
    vision_.show(frame_);
    update();
    ++frame_;
  }
  EXPECT_EQ(vision_.without_, 1u);
}

// Only one of the two is before the camera, in other clothes than the one who is missing.
TEST_F(PeopleCourses, WhoWearsOtherClothesIsNotTheOneWhoIsMissingUntilThatOneIsForgotten) {
  for (frame_ = 0; frame_ < 40; ++frame_) {
    vision_.show(frame_);
    update();
  }
  auto dancers = crossing_couple(12.0);
  for (CoupleDancer& dancer : dancers) dancer.clothes.fill(PictureColour(0.9f, 0.2f, 0.2f));
  for (Pose& pose : dancers[0].poses) pose.p_WH_m.x() = 30.0f;
  SceneCamera camera;
  camera.middle_m = Eigen::Vector3d(0.0, 0.0, 0.0);
  CoupleScene others(dancers, kCoupleHz, camera, {}, 2);
  const auto is_found_after = [&](Duration away) {
    tracker_.lose_all();
    others.show(60);
    const auto people = tracker_.update(others, scene_.time(39) + away);
    return people[0].is_found || people[1].is_found;
  };
  EXPECT_FALSE(is_found_after(Duration::s(3)));
  EXPECT_TRUE(is_found_after(Duration::s(11)));
}

TEST_F(PeopleCourses, ABodyIsNotGivenToOneWhoIsLeftOutOfThePicture) {
  approach();
  // The other is lost in the picture before.
  const auto instead = std::exchange(vision_.instead, std::nullopt);
  vision_.last_blind = 9;
  EXPECT_FALSE(update()[1].is_found);
  vision_.show(++frame_);
  vision_.instead = instead;
  vision_.last_blind = 0;
  const auto people = tracker_.update(vision_, scene_.time(frame_), {true, false, true, true});
  EXPECT_EQ(tracker_.counters().reassigned, 0u);
  EXPECT_FALSE(people[1].is_found);
}

}  // namespace
}  // namespace dance
