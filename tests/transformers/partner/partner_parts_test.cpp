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

Figure figure_at(const Palms& palms, const Vector3f& hips) {
  return {palms, hips, -Vector3f::UnitZ()};
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

TEST(PartnerTrack, SaysHowHandsAreTurnedBetweenPoses) {
  PartnerTrack track;
  for (std::size_t i = 0; i < 4; ++i)
    track.take(standing_at({0.0f, 0.95f, 0.0f}, 0.1f * static_cast<float>(i), couple_time(i)));
  const auto half = track.at(couple_time(1) + (couple_time(2) - couple_time(1)) / 2);
  ASSERT_TRUE(half.has_value());
  const Eigen::Quaternionf is = exp_rotation(Vector3f(0.0f, 0.15f, 0.0f));
  for (const Eigen::Quaternionf& R : half->R_WHand) EXPECT_LT(R.angularDistance(is), 1e-3f);
  EXPECT_LT((half->facing_W - is * Vector3f::UnitZ()).norm(), 1e-3f);
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
  const Vector3f hips(0.0f, 0.95f, 0.9f);
  const Figure own = figure_at({Vector3f(0.25f, 1.0f, 0.5f), Vector3f(-0.25f, 1.0f, 0.5f)}, hips);
  const Meeting met = Meeting::of(own, partner);
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair)
    EXPECT_LT((met.palm_at(pair, hips, partner) - own.palms[pair / 2]).norm(), 1e-6f);
  // Both walk a quarter round their middle.
  const auto turned = [](const Vector3f& v) { return Vector3f(v.z(), v.y(), -v.x()); };
  const PartnerMoment later = moment_with(turned(partner.p_WPalm_m[0]),
                                          turned(partner.p_WPalm_m[1]), turned(partner.p_WHips_m));
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair)
    EXPECT_LT((met.palm_at(pair, turned(hips), later) - turned(own.palms[pair / 2])).norm(), 1e-5f);
}

// Two palms that dance, of which the dancer's follows the partner's so far; predictions know
// nothing of it.
class TwoPalms {
 public:
  explicit TwoPalms(float follows, float apart_m = 0.1f) : follows_(follows), apart_m_(apart_m) {}

  void dance(int moments) {
    for (int i = 0; i < moments; ++i, ++turn_) {
      Meeting met = meeting();
      holds.follow(met, kStep_s);
      holds.describe(met);
      const Vector3f moved = moved_at(turn_);
      holds.learn(met, met.own, kAhead_s,
                  {Vector3f(met.own.palms[0] + follows_ * moved), met.own.palms[1]}, then(moved),
                  kStep_s);
    }
  }
  void set_follows(float follows) { follows_ = follows; }
  // What is done to a prediction where the partner's palm has gone up by 0.1 m.
  std::array<PalmPull, 2> pulls() const {
    Meeting met = meeting();
    holds.describe(met);
    return holds.pulls(met, met.own, kAhead_s, then({0.0f, 0.1f, 0.0f}));
  }
  // How far up the palm is drawn, of the partner's way.
  float drawn() const { return pulls()[0].share * pulls()[0].shift_W_m.y() / 0.1f; }

  HandHolds holds;

 private:
  static constexpr float kAhead_s = 0.2f;
  static constexpr double kStep_s = 1.0 / 30.0;

  static Vector3f moved_at(int turn) {
    return {0.06f * std::sin(0.4f * static_cast<float>(turn)), 0.05f, 0.0f};
  }
  PartnerMoment then(const Vector3f& moved) const {
    return moment_with(Vector3f(0.0f, 1.0f, 0.5f) + moved, {-9.0f, -1.0f, 0.0f},
                       {0.0f, 0.95f, 0.0f});
  }
  Meeting meeting() const {
    return Meeting::of(
        figure_at({Vector3f(0.0f, 1.0f, 0.5f + apart_m_), Vector3f(9.0f, 1.0f, 0.0f)},
                  {0.0f, 0.95f, 1.0f}),
        then(Vector3f::Zero()));
  }

  float follows_, apart_m_;
  int turn_ = 0;
};

TEST(HandHolds, SayNothingBeforeTheyHaveProvedRight) {
  const TwoPalms palms(1.0f);
  EXPECT_EQ(palms.holds.trust(), 0.0f);
  for (const PalmPull& pull : palms.pulls()) EXPECT_EQ(pull.share, 0.0f);
}

TEST(HandHolds, LearnWhetherPalmsFollowTheOthers) {
  TwoPalms held(1.0f), half(0.5f), free(0.0f), against(-1.0f), far(1.0f, 0.6f);
  for (TwoPalms* palms : {&held, &half, &free, &against, &far}) palms->dance(60);
  EXPECT_EQ(held.holds.trust(), 1.0f);
  EXPECT_GT(held.drawn(), 0.6f);
  EXPECT_GT(held.drawn(), half.drawn() + 0.1f);
  EXPECT_GT(half.drawn(), 0.2f);
  EXPECT_LT(free.drawn(), 0.02f);
  EXPECT_EQ(against.drawn(), 0.0f);
  EXPECT_EQ(far.drawn(), 0.0f);
  EXPECT_EQ(held.pulls()[1].share, 0.0f);
}

TEST(HandHolds, ForgetWithinASecondThatPalmsWereHeld) {
  TwoPalms palms(1.0f);
  palms.dance(60);
  const float held = palms.drawn();
  palms.set_follows(0.0f);
  palms.dance(30);
  EXPECT_LT(palms.drawn(), 0.6f * held);
}

TEST(HandHolds, WhatPredictionsMissedTheyMissAgain) {
  // Of a partner who is proved to count, and stands.
  TwoPalms palms(1.0f);
  palms.dance(60);
  Meeting met = Meeting::of(
      figure_at({Vector3f(0.0f, 1.0f, 0.6f), Vector3f(9.0f, 1.0f, 0.0f)}, {0.0f, 0.95f, 1.0f}),
      moment_with({0.0f, 1.0f, 0.5f}, {-9.0f, -1.0f, 0.0f}, {0.0f, 0.95f, 0.0f}));
  const auto without = palms.holds.pulls(met, met.own, 0.2f, met.partner);
  met.missed_m[0] = Vector3f(0.0f, 0.1f, 0.0f);
  met.missed_ahead_s = 0.2f;
  const auto with = palms.holds.pulls(met, met.own, 0.2f, met.partner);
  const auto nearer = palms.holds.pulls(met, met.own, 0.1f, met.partner);
  const auto up = [&](const std::array<PalmPull, 2>& pulls) {
    return pulls[0].share * pulls[0].shift_W_m.y() - without[0].share * without[0].shift_W_m.y();
  };
  EXPECT_GT(up(with), 0.003f);
  EXPECT_LT(up(with), 0.05f);
  EXPECT_LT((with[0].shift_W_m - without[0].shift_W_m).cross(Vector3f::UnitY()).norm(), 1e-6f);
  EXPECT_LT(nearer[0].shift_W_m.norm(), 0.1f);
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
