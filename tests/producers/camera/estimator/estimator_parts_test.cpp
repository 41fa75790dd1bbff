#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/core.hpp>

#include "core/base/random.h"
#include "producers/camera/estimator/body_smoothing.h"
#include "producers/camera/estimator/identity_switch_detector.h"
#include "producers/camera/estimator/one_euro.h"
#include "producers/camera/estimator/target_tracker.h"
#include "producers/camera/region/region_sampler.h"

namespace dance {
namespace {

constexpr float kQuarterTurn = 0.5f * std::numbers::pi_v<float>;

cv::Mat random_picture(int rows, int columns) {
  Random random(3);
  cv::Mat picture(rows, columns, CV_8UC3);
  for (int r = 0; r < rows; ++r)
    for (int i = 0; i < 3 * columns; ++i)
      picture.ptr<std::uint8_t>(r)[i] = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

float at(const std::vector<float>& numbers, int side, int row, int column, int channel) {
  return numbers[static_cast<std::size_t>((row * side + column) * 3 + channel)];
}

TEST(RegionSampler, TakesPixelsAsTheyAreWhereTheyFit) {
  const cv::Mat picture = random_picture(16, 16);
  std::vector<float> numbers(16 * 16 * 3);
  sample_region(picture, {8.0f, 8.0f, 16.0f, 0.0f}, 16, Beyond::kNearest, 0.0f, 255.0f, numbers);
  for (int r = 0; r < 16; ++r)
    for (int c = 0; c < 16; ++c)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(at(numbers, 16, r, c, k), picture.at<cv::Vec3b>(r, c)[2 - k], 1e-3);
}

TEST(RegionSampler, TurnsClockwise) {
  const cv::Mat picture = random_picture(16, 16);
  std::vector<float> numbers(16 * 16 * 3);
  sample_region(picture, {8.0f, 8.0f, 16.0f, kQuarterTurn}, 16, Beyond::kNearest, 0.0f, 255.0f,
                numbers);
  // What was at the right is on top.
  for (int r = 0; r < 16; ++r)
    for (int c = 0; c < 16; ++c)
      EXPECT_NEAR(at(numbers, 16, r, c, 0), picture.at<cv::Vec3b>(c, 15 - r)[2], 0.05);
}

TEST(RegionSampler, ReadsBetweenPixels) {
  cv::Mat picture(1, 2, CV_8UC3, cv::Scalar::all(0));
  picture.at<cv::Vec3b>(0, 1) = {100, 100, 100};
  std::vector<float> numbers(3);
  // One point in the middle between both.
  sample_region(picture, {1.0f, 0.5f, 1.0f, 0.0f}, 1, Beyond::kNearest, 0.0f, 255.0f, numbers);
  EXPECT_NEAR(numbers[0], 50.0f, 1e-4);
  sample_region(picture, {1.25f, 0.5f, 1.0f, 0.0f}, 1, Beyond::kNearest, 0.0f, 255.0f, numbers);
  EXPECT_NEAR(numbers[0], 75.0f, 1e-4);
}

TEST(RegionSampler, BeyondThePictureIsTheBorderOrBlack) {
  const cv::Mat picture(4, 4, CV_8UC3, cv::Scalar::all(200));
  std::vector<float> numbers(8 * 8 * 3);
  const BodyRegion region{2.0f, 2.0f, 8.0f, 0.0f};
  sample_region(picture, region, 8, Beyond::kNearest, 0.0f, 1.0f, numbers);
  EXPECT_NEAR(at(numbers, 8, 0, 0, 0), 200.0f / 255.0f, 1e-5);
  sample_region(picture, region, 8, Beyond::kBlack, -1.0f, 1.0f, numbers);
  EXPECT_EQ(at(numbers, 8, 0, 0, 0), -1.0f);
  EXPECT_NEAR(at(numbers, 8, 4, 4, 0), 200.0f / 127.5f - 1.0f, 1e-5);
}

TEST(RegionSampler, ReadsNothingFarAwayFromThePicture) {
  const cv::Mat picture = random_picture(5, 7);
  std::vector<float> numbers(32 * 32 * 3);
  for (const float far : {-1e9f, -100.0f, 100.0f, 1e9f})
    for (const Beyond beyond : {Beyond::kBlack, Beyond::kNearest})
      sample_region(picture, {far, -far, 50.0f, 0.3f}, 32, beyond, 0.0f, 1.0f, numbers);
  for (const float value : numbers) EXPECT_TRUE(value >= 0.0f && value <= 1.0f);
}

TEST(RegionOf, StandsUprightWithTheEdgeAbove) {
  const BodyRegion upright = region_of({100.0f, 200.0f}, {100.0f, 120.0f});
  EXPECT_NEAR(upright.turn_rad, 0.0f, 1e-6);
  EXPECT_NEAR(upright.side_px, 200.0f, 1e-4);
  EXPECT_NEAR(region_of({0.0f, 0.0f}, {10.0f, 0.0f}).turn_rad, kQuarterTurn, 1e-6);
  EXPECT_NEAR(region_of({0.0f, 0.0f}, {-10.0f, 0.0f}).turn_rad, -kQuarterTurn, 1e-6);
}

TEST(OneEuro, StillsWhatStandsAndLetsGoWhatMoves) {
  Random random(5);
  const OneEuroSetting setting{0.1, 40.0, 1.0};
  OneEuro still, moving;
  double trembling = 0.0, trembling_smooth = 0.0, lag = 0.0;
  for (int i = 0; i < 300; ++i) {
    const auto noise = static_cast<float>(0.001 * random.normal());
    const float smooth = still.next(1.0f + noise, 30.0, 1.0, setting);
    const float ramp = static_cast<float>(i) / 30.0f;
    const float followed = moving.next(ramp, 30.0, 1.0, setting);
    if (i < 100) continue;
    trembling += noise * noise;
    trembling_smooth += (smooth - 1.0f) * (smooth - 1.0f);
    lag = std::max(lag, static_cast<double>(ramp - followed));
  }
  EXPECT_LT(trembling_smooth, 0.25 * trembling);
  EXPECT_LT(lag, 0.01);
}

TEST(OneEuro, TheFirstNumberComesBackAsItIs) {
  OneEuro filter;
  EXPECT_EQ(filter.next(3.5f, 30.0, 1.0, {}), 3.5f);
  EXPECT_NE(filter.next(9.5f, 30.0, 1.0, {}), 9.5f);
  filter.reset();
  EXPECT_EQ(filter.next(-2.0f, 30.0, 1.0, {}), -2.0f);
}

SeenBody body_at(float metres, float pixels) {
  SeenBody body;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    body.world_m[i].setConstant(metres);
    body.image_px[i].setConstant(pixels);
    body.visibility[i] = 1.0f;
  }
  body.next_px = {Eigen::Vector2f(100.0f, 100.0f), Eigen::Vector2f(100.0f, 300.0f)};
  return body;
}

// As the original's filters: those of metres do not run without a body, those of pixels do.
TEST(BodySmoothing, AfterALossPixelsBeginAnewAndMetresGoOn) {
  BodySmoothing lost, uninterrupted;
  const auto at = [](int i) { return MonoTime{} + Duration::ms(1000 + 33 * i); };
  for (int i = 0; i < 30; ++i)
    for (BodySmoothing* smoothing : {&lost, &uninterrupted}) {
      SeenBody body = body_at(0.5f, 200.0f);
      if (i == 20 && smoothing == &lost) {
        smoothing->lose();
        continue;
      }
      smoothing->smooth(at(i), false, body);
    }
  // A noisy picture: metres hardly follow it at once.
  SeenBody a = body_at(0.51f, 203.0f), b = a;
  lost.lose();
  lost.smooth(at(31), false, a);
  uninterrupted.smooth(at(31), false, b);
  EXPECT_NEAR(a.world_m[5].x(), b.world_m[5].x(), 1e-3f);
  EXPECT_LT(a.world_m[5].x(), 0.508f);
  EXPECT_EQ(a.image_px[5].x(), 203.0f);
  // Another body: nothing of the last one.
  SeenBody other = body_at(0.9f, 203.0f);
  lost.reset();
  lost.smooth(at(32), false, other);
  EXPECT_EQ(other.world_m[5].x(), 0.9f);
}

MonoTime ms(std::int64_t n) { return MonoTime{} + Duration::ms(n); }

TEST(TargetTracker, ChoosesAsOneWishes) {
  const std::array<SeenPerson, 3> people{SeenPerson{0.9f, {100.0f, 100.0f, 50.0f, 0.0f}},
                                         SeenPerson{0.8f, {300.0f, 100.0f, 90.0f, 0.0f}},
                                         SeenPerson{0.7f, {500.0f, 100.0f, 60.0f, 0.0f}}};
  const TargetTracker memory;
  FollowOptions follow;
  EXPECT_EQ(memory.choose(people, ms(0), follow), &people[0]);
  follow.choice = FollowOptions::Choice::kLargest;
  EXPECT_EQ(memory.choose(people, ms(0), follow), &people[1]);
  follow.choice = FollowOptions::Choice::kNearest;
  follow.place_px = {480.0f, 90.0f};
  EXPECT_EQ(memory.choose(people, ms(0), follow), &people[2]);
  EXPECT_EQ(memory.choose({}, ms(0), follow), nullptr);
}

TEST(TargetTracker, ALostPersonComesFirstForAWhile) {
  const std::array<SeenPerson, 2> people{SeenPerson{0.9f, {100.0f, 100.0f, 50.0f, 0.0f}},
                                         SeenPerson{0.7f, {500.0f, 100.0f, 60.0f, 0.0f}}};
  TargetTracker memory;
  const FollowOptions follow;
  memory.update({490.0f, 100.0f, 60.0f, 0.0f}, ms(1000));
  memory.on_lost();
  EXPECT_EQ(memory.choose(people, ms(1100), follow), &people[1]);
  // Somebody else, far away, is not taken for the lost one at once.
  const std::span<const SeenPerson> other(people.data(), 1);
  EXPECT_EQ(memory.choose(other, ms(1100), follow), nullptr);
  EXPECT_EQ(memory.choose(other, ms(2000), follow), &people[0]);
  EXPECT_EQ(memory.choose(people, ms(9000), follow), &people[0]);
}

TEST(TargetTracker, ABodyDoesNotJump) {
  TargetTracker memory;
  // It moves by 10 px, a tenth of the region's side, each 33 ms.
  for (int i = 0; i < 20; ++i) {
    const BodyRegion region{100.0f + 10.0f * static_cast<float>(i), 50.0f, 100.0f, 0.0f};
    EXPECT_TRUE(memory.is_plausible(region, ms(33 * i)));
    memory.update(region, ms(33 * i));
  }
  EXPECT_TRUE(memory.is_plausible({300.0f, 50.0f, 100.0f, 0.0f}, ms(33 * 20)));
  // To somebody who stands where it passed.
  EXPECT_FALSE(memory.is_plausible({260.0f, 50.0f, 100.0f, 0.0f}, ms(33 * 20)));
  EXPECT_FALSE(memory.is_plausible({300.0f, 50.0f, 170.0f, 0.0f}, ms(33 * 20)));
  EXPECT_FALSE(memory.is_plausible({300.0f, 50.0f, 60.0f, 0.0f}, ms(33 * 20)));
}

// Somebody walks past a dancer who stands at 600 px; while they are near each other one person is
// seen, and the one who is followed is from then on wherever `taken_along` says.
class Passing {
 public:
  explicit Passing(float walk_px_s) : walk_px_s_(walk_px_s) {}

  // Gives where the region was sent, if anywhere.
  std::optional<BodyRegion> play(bool is_taken_along) {
    IdentitySwitchDetector watch;
    bool have_met = false;
    for (int i = 0; i < 100; ++i) {
      const MonoTime now = ms(50 * i);
      const float walker_px = 200.0f + walk_px_s_ * 0.05f * static_cast<float>(i);
      const bool is_one = std::abs(walker_px - 600.0f) < 60.0f;
      have_met = have_met || is_one;
      const BodyRegion followed = region_at(is_taken_along && have_met ? walker_px : 600.0f);
      const std::array<SeenPerson, 2> both{SeenPerson{0.9f, region_at(walker_px)},
                                           SeenPerson{0.8f, region_at(600.0f)}};
      if (!watch.is_due(now)) continue;
      const auto sent = watch.update({both.data(), is_one ? 1u : 2u}, followed, now);
      if (sent) return sent;
    }
    return std::nullopt;
  }

 private:
  static BodyRegion region_at(float x_px) { return {x_px, 300.0f, 500.0f, 0.0f}; }
  float walk_px_s_;
};

TEST(IdentitySwitchDetector, WhoPassesDoesNotTakeTheDancersPlace) {
  for (const float walk_px_s : {120.0f, 200.0f, 300.0f}) {
    const auto sent = Passing(walk_px_s).play(true);
    ASSERT_TRUE(sent) << walk_px_s;
    EXPECT_NEAR(sent->centre_x_px, 600.0f, 1.0f);
  }
}

TEST(IdentitySwitchDetector, NobodyIsExchangedWhereTheDancerStayed) {
  for (const float walk_px_s : {120.0f, 200.0f, 300.0f})
    EXPECT_FALSE(Passing(walk_px_s).play(false)) << walk_px_s;
}

TEST(IdentitySwitchDetector, LooksSeldomAtOneWhoIsAlone) {
  IdentitySwitchDetector watch;
  const SeenPerson alone{0.9f, {600.0f, 300.0f, 500.0f, 0.0f}};
  int looks = 0;
  for (int i = 0; i < 300; ++i) {
    if (!watch.is_due(ms(33 * i))) continue;
    ++looks;
    EXPECT_FALSE(watch.update({&alone, 1}, alone.region, ms(33 * i)));
  }
  EXPECT_LE(looks, 10);
}

}  // namespace
}  // namespace dance
