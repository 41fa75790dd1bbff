#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/rotation_vector.h"
#include "tests/transformers/partner/salsa_couple.h"
#include "transformers/partner/couple_finder.h"
#include "transformers/partner/hand_holds.h"
#include "transformers/partner/partner_tracks.h"

namespace dance {
namespace {

using Eigen::Vector3f;

Pose standing_at(const Vector3f& place, float heading_rad, MonoTime time) {
  Pose pose;
  pose.p_WH_m = place;
  pose.R_PB[0] = exp_rotation(Vector3f(0.0f, heading_rad, 0.0f));
  pose.capture_time = time;
  pose.clock_id = 1;
  return pose;
}

PartnerMoment moment_with(const Vector3f& left, const Vector3f& right, const Vector3f& hips) {
  return {MonoTime(), {left, right}, hips, Vector3f::UnitZ()};
}

TEST(PartnerTrack, SaysWherePalmsWereBetweenPosesAndALittleBeyond) {
  PartnerTrack track;
  EXPECT_FALSE(track.at(couple_time(0)).has_value());
  for (std::size_t i = 0; i < 10; ++i)
    track.take(standing_at({0.01f * static_cast<float>(i), 0.95f, 0.0f}, 0.0f, couple_time(i)));
  const auto half = track.at(couple_time(4) + (couple_time(5) - couple_time(4)) / 2);
  ASSERT_TRUE(half.has_value());
  EXPECT_NEAR(half->p_WHips_m.x(), 0.045f, 1e-4f);
  const auto beyond = track.at(couple_time(11));
  ASSERT_TRUE(beyond.has_value());
  EXPECT_NEAR(beyond->p_WHips_m.x(), 0.11f, 1e-4f);
  // No further than kAhead.
  EXPECT_FALSE(track.at(couple_time(100)).has_value());
  EXPECT_NEAR(track.at_latest(couple_time(100))->p_WHips_m.x(), 0.126f, 0.002f);
  EXPECT_FALSE(track.at(couple_time(0) - Duration::ms(1)).has_value());
}

TEST(PartnerTrack, BeginsAnewAfterAGapAndWithAnotherClock) {
  PartnerTrack track;
  for (std::size_t i = 0; i < 10; ++i)
    track.take(standing_at({0.0f, 0.95f, 0.0f}, 0.0f, couple_time(i)));
  track.take(standing_at({5.0f, 0.95f, 0.0f}, 0.0f, couple_time(3)));  // late: refused
  EXPECT_NEAR(track.newest().p_WHips_m.x(), 0.0f, 1e-6f);
  track.take(standing_at({1.0f, 0.95f, 0.0f}, 0.0f, couple_time(60)));
  EXPECT_FALSE(track.at(couple_time(60)).has_value());  // of one pose alone nothing is said
  track.take(standing_at({1.0f, 0.95f, 0.0f}, 0.0f, couple_time(61)));
  EXPECT_TRUE(track.at(couple_time(61)).has_value());
  EXPECT_FALSE(track.at(couple_time(9)).has_value());
  Pose other = standing_at({2.0f, 0.95f, 0.0f}, 0.0f, couple_time(5));
  other.clock_id = 2;
  track.take(other);
  EXPECT_EQ(track.clock_id(), 2u);
  EXPECT_NEAR(track.newest().p_WHips_m.x(), 2.0f, 1e-6f);
}

TEST(PartnerTrack, NoiseIsNotThrownFarBeyondTheNewest) {
  // Poses 2 ms apart, each off by 2 mm the other way.
  PartnerTrack track;
  for (int i = 0; i < 60; ++i)
    track.take(standing_at({i % 2 == 0 ? 0.002f : -0.002f, 0.95f, 0.0f}, 0.0f,
                           couple_time(0) + Duration::ms(2 * i)));
  const auto beyond = track.at(track.newest().time + PartnerTrack::kAhead);
  ASSERT_TRUE(beyond.has_value());
  EXPECT_LT(std::abs(beyond->p_WHips_m.x()), 0.01f);
}

TEST(PartnerTracks, AFullHouseGivesTheSilentOnesPlaceToANewcomer) {
  PartnerTracks tracks;
  const auto pose_at = [](float x, std::size_t frame) {
    return standing_at({x, 0.95f, 0.0f}, 0.0f, couple_time(frame));
  };
  for (std::size_t g = 0; g < PartnerTracks::kMost; ++g)
    tracks.take(*GuestId::parse("g" + std::to_string(g)), pose_at(0.0f, g == 2 ? 0 : 5000));
  const std::uint32_t generation = tracks.generation(2);
  tracks.take(*GuestId::parse("new"), pose_at(7.0f, 5001));
  EXPECT_EQ(tracks.guest(2), *GuestId::parse("new"));
  EXPECT_NE(tracks.generation(2), generation);
  EXPECT_EQ(tracks.refused(), 0u);
  tracks.take(*GuestId::parse("another"), pose_at(7.0f, 5002));
  EXPECT_EQ(tracks.refused(), 1u);
}

TEST(PartnerTracks, KeepsEachDancerAndNoMoreThanItsBound) {
  PartnerTracks tracks;
  for (std::size_t g = 0; g < PartnerTracks::kMost + 3; ++g) {
    const GuestId guest = *GuestId::parse("g" + std::to_string(g));
    tracks.take(guest, standing_at({static_cast<float>(g), 0.95f, 0.0f}, 0.0f, couple_time(0)));
  }
  ASSERT_EQ(tracks.size(), PartnerTracks::kMost);
  for (std::size_t p = 0; p < tracks.size(); ++p)
    EXPECT_NEAR(tracks[p].newest().p_WHips_m.x(), static_cast<float>(p), 1e-6f);
}

TEST(Meeting, OffsetsTurnWithTheLineBetweenTheTwo) {
  const PartnerMoment partner =
      moment_with({0.2f, 1.0f, 0.4f}, {-0.2f, 1.0f, 0.4f}, {0.0f, 0.95f, 0.0f});
  const Palms own{Vector3f(0.25f, 1.0f, 0.5f), Vector3f(-0.25f, 1.0f, 0.5f)};
  const Vector3f hips(0.0f, 0.95f, 0.9f);
  const Meeting met = Meeting::of(own, hips, partner);
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair)
    EXPECT_LT((met.palm_at(pair, hips, partner) - own[pair / 2]).norm(), 1e-6f);
  // Both walk a quarter round their middle.
  const auto turned = [](const Vector3f& v) { return Vector3f(v.z(), v.y(), -v.x()); };
  const PartnerMoment later = moment_with(turned(partner.p_WPalm_m[0]),
                                          turned(partner.p_WPalm_m[1]), turned(partner.p_WHips_m));
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair)
    EXPECT_LT((met.palm_at(pair, turned(hips), later) - turned(own[pair / 2])).norm(), 1e-5f);
}

// A palm that follows the partner's exactly, and predictions that stay behind.
HandHolds taught(float follows, int moments, float apart_m = 0.05f) {
  HandHolds holds;
  for (int i = 0; i < moments; ++i) {
    const Vector3f moved(0.06f * std::sin(0.4f * static_cast<float>(i)), 0.05f, 0.0f);
    const Vector3f hips(0.0f, 0.95f, 1.0f), partner_hips(0.0f, 0.95f, 0.0f);
    const Vector3f far(9.0f, 1.0f, 0.0f);
    const Palms own{Vector3f(0.0f, 1.0f, 0.5f + apart_m), far};
    const PartnerMoment then = moment_with({0.0f, 1.0f, 0.5f}, -far, partner_hips);
    const PartnerMoment now = moment_with(Vector3f(0.0f, 1.0f, 0.5f) + moved, -far, partner_hips);
    const Meeting met = Meeting::of(own, hips, then);
    holds.learn(met, own, hips, {Vector3f(own[0] + follows * moved), far}, now, 1.0 / 30.0);
  }
  return holds;
}

TEST(HandHolds, SayNothingBeforeTheyHaveProvedRight) {
  const HandHolds holds;
  EXPECT_EQ(holds.trust(), 0.0f);
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair) EXPECT_EQ(holds.share(pair, 0.05f), 0.0f);
}

TEST(HandHolds, LearnHowFarPalmsFollowTheOthers) {
  EXPECT_GT(taught(1.0f, 60).share(0, 0.05f), 0.7f);
  EXPECT_NEAR(taught(0.5f, 60).share(0, 0.05f), 0.5f, 0.13f);
  EXPECT_LT(taught(0.0f, 60).share(0, 0.05f), 0.02f);
  EXPECT_EQ(taught(-1.0f, 60).share(0, 0.05f), 0.0f);
  // Other palms of the same two follow as usual; those that are far apart not at all.
  EXPECT_GT(taught(1.0f, 60).share(3, 0.05f), 0.3f);
  EXPECT_LT(taught(1.0f, 60).share(3, 0.05f), taught(1.0f, 60).share(0, 0.05f));
  EXPECT_EQ(taught(1.0f, 60).share(0, 0.6f), 0.0f);
}

TEST(HandHolds, ForgetWithinSecondsThatPalmsWereHeld) {
  HandHolds holds = taught(1.0f, 60);
  const HandHolds open = taught(0.0f, 90);
  EXPECT_LT(open.share(0, 0.05f), 0.05f);
  const Vector3f hips(0.0f, 0.95f, 1.0f), far(9.0f, 1.0f, 0.0f);
  for (int i = 0; i < 90; ++i) {
    const Palms own{Vector3f(0.0f, 1.0f, 0.55f), far};
    const PartnerMoment then = moment_with({0.0f, 1.0f, 0.5f}, -far, Vector3f(0.0f, 0.95f, 0.0f));
    PartnerMoment now = then;
    now.p_WPalm_m[0].y() += 0.06f;
    holds.learn(Meeting::of(own, hips, then), own, hips, own, now, 1.0 / 30.0);
  }
  EXPECT_LT(holds.share(0, 0.05f), 0.25f);
}

TEST(HandHolds, PullTowardsThePartnersPalm) {
  const HandHolds holds = taught(1.0f, 60);
  const Vector3f hips(0.0f, 0.95f, 1.0f), far(9.0f, 1.0f, 0.0f);
  const Palms own{Vector3f(0.0f, 1.0f, 0.55f), far};
  const PartnerMoment then = moment_with({0.0f, 1.0f, 0.5f}, -far, Vector3f(0.0f, 0.95f, 0.0f));
  PartnerMoment now = then;
  now.p_WPalm_m[0] += Vector3f(0.0f, 0.1f, 0.0f);
  const auto pulls = holds.pulls(Meeting::of(own, hips, then), own, hips, now);
  EXPECT_LT((pulls[0].shift_W_m - Vector3f(0.0f, 0.1f, 0.0f)).norm(), 1e-4f);
  EXPECT_GT(pulls[0].share, 0.7f);
  EXPECT_EQ(pulls[1].share, 0.0f);
}

// Two who face each other at a distance, for so long; whether they are a couple then.
std::optional<std::size_t> found_at(CoupleFinder& finder, const PartnerTracks& dancers,
                                    const Vector3f& hips, const Vector3f& facing, double seconds) {
  const Palms own{Vector3f(hips + Vector3f(0.3f, 0.1f, 0.0f)),
                  Vector3f(hips + Vector3f(-0.3f, 0.1f, 0.0f))};
  std::optional<std::size_t> found;
  const MonoTime then = couple_time(1);
  for (int i = 0; i < static_cast<int>(seconds * kCoupleHz); ++i)
    found = finder.update(dancers, {own, hips, facing, 1, then, then}, 1.0 / kCoupleHz);
  return found;
}

PartnerTracks dancers_at(const std::vector<Vector3f>& places) {
  PartnerTracks dancers;
  for (std::size_t g = 0; g < places.size(); ++g)
    for (std::size_t i = 0; i < 3; ++i)
      dancers.take(*GuestId::parse("g" + std::to_string(g)),
                   standing_at(places[g], 0.0f, couple_time(i)));
  return dancers;
}

TEST(CoupleFinder, FindsWhoIsNearAndFacesThem) {
  const PartnerTracks dancers = dancers_at({{3.0f, 0.95f, 0.0f}, {0.0f, 0.95f, 0.0f}});
  const Vector3f before(0.0f, 0.95f, 0.8f);
  CoupleFinder finder;
  EXPECT_FALSE(found_at(finder, dancers, before, -Vector3f::UnitZ(), 0.3).has_value());
  EXPECT_EQ(found_at(finder, dancers, before, -Vector3f::UnitZ(), 2.0), 1u);
  // A turn of a beat ends no couple; walking away does.
  EXPECT_EQ(found_at(finder, dancers, before, Vector3f::UnitZ(), 0.4), 1u);
  EXPECT_FALSE(found_at(finder, dancers, {0.0f, 0.95f, 3.0f}, -Vector3f::UnitZ(), 3.0).has_value());
}

TEST(CoupleFinder, WhoHasLeftIsNobodysPartnerAndWhoTakesThePlaceIs) {
  PartnerTracks dancers = dancers_at({{0.0f, 0.95f, 0.0f}, {0.0f, 0.95f, 0.1f}});
  const Vector3f hips(0.0f, 0.95f, 0.8f), facing = -Vector3f::UnitZ();
  const Palms own{Vector3f(hips + Vector3f(0.3f, 0.1f, 0.0f)),
                  Vector3f(hips + Vector3f(-0.3f, 0.1f, 0.0f))};
  CoupleFinder finder;
  const auto found = found_at(finder, dancers, hips, facing, 3.0);
  ASSERT_TRUE(found.has_value());
  // Only the other dances on.
  const std::size_t other = 1 - *found;
  std::optional<std::size_t> partner = found;
  for (std::size_t i = 3; i < 300; ++i) {
    dancers.take(dancers.guest(other), standing_at({0.0f, 0.95f, 0.0f}, 0.0f, couple_time(i)));
    partner = finder.update(dancers, {own, hips, facing, 1, couple_time(i), couple_time(i)},
                            1.0 / kCoupleHz);
  }
  EXPECT_EQ(partner, other);
  // Nor is one of another clock.
  CoupleFinder elsewhere;
  for (std::size_t i = 0; i < 300; ++i)
    partner = elsewhere.update(dancers, {own, hips, facing, 9, couple_time(299), couple_time(299)},
                               1.0 / kCoupleHz);
  EXPECT_FALSE(partner.has_value());
}

TEST(CoupleFinder, NobodyIsAPartnerFromAfarOrFromBehind) {
  const PartnerTracks dancers = dancers_at({{0.0f, 0.95f, 0.0f}});
  CoupleFinder finder;
  EXPECT_FALSE(found_at(finder, dancers, {0.0f, 0.95f, 2.5f}, -Vector3f::UnitZ(), 5.0).has_value());
  EXPECT_FALSE(
      found_at(finder, dancers, {0.0f, 0.95f, -0.9f}, -Vector3f::UnitZ(), 5.0).has_value());
  EXPECT_FALSE(
      found_at(finder, PartnerTracks(), {0, 0.95f, 0}, -Vector3f::UnitZ(), 5.0).has_value());
}

TEST(CoupleFinder, GoesWithWhoeverTheDancerChangesTo) {
  const PartnerTracks dancers = dancers_at({{0.0f, 0.95f, 0.0f}, {4.0f, 0.95f, 0.0f}});
  CoupleFinder finder;
  EXPECT_EQ(found_at(finder, dancers, {0.0f, 0.95f, 0.8f}, -Vector3f::UnitZ(), 3.0), 0u);
  EXPECT_EQ(found_at(finder, dancers, {4.0f, 0.95f, 0.8f}, -Vector3f::UnitZ(), 3.0), 1u);
}

}  // namespace
}  // namespace dance
