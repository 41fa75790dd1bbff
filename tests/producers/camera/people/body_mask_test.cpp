#include "producers/camera/people/body_mask.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace dance {
namespace {

constexpr int kSide = BodyMask::kMostSide_px;

// Upright, 400 pixels high, the middle of the hips at (300, 300).
SeenBody upright_body() {
  SeenBody body;
  for (auto& p : body.image_px) p = {300.0f, 300.0f, 0.0f};
  const auto put = [&](Landmark left, float x, float y) {
    body.image_px[index_of(left)] = {300.0f + x, y, 0.0f};
    body.image_px[index_of(left) + 1] = {300.0f - x, y, 0.0f};
  };
  body.image_px[index_of(Landmark::kNose)] = {300.0f, 130.0f, 0.0f};
  put(Landmark::kLeftEar, 12.0f, 130.0f);
  put(Landmark::kLeftShoulder, 40.0f, 180.0f);
  put(Landmark::kLeftElbow, 90.0f, 240.0f);
  put(Landmark::kLeftWrist, 130.0f, 200.0f);
  put(Landmark::kLeftIndex, 140.0f, 190.0f);
  put(Landmark::kLeftHip, 25.0f, 300.0f);
  put(Landmark::kLeftKnee, 25.0f, 400.0f);
  put(Landmark::kLeftAnkle, 25.0f, 490.0f);
  put(Landmark::kLeftHeel, 25.0f, 495.0f);
  put(Landmark::kLeftFootIndex, 30.0f, 500.0f);
  body.visibility.fill(0.9f);
  body.next_px = {Eigen::Vector2f(300.0f, 300.0f), Eigen::Vector2f(300.0f, 80.0f)};
  return body;
}

constexpr BodyRegion kRegion{300.0f, 300.0f, 550.0f, 0.0f};

class BodyMaskTest : public testing::Test {
 protected:
  void SetUp() override { mask_->begin(kRegion); }
  std::unique_ptr<BodyMask> mask_ = std::make_unique<BodyMask>();
};

TEST_F(BodyMaskTest, CoversTheBodyAndNotWhatIsBesideIt) {
  EXPECT_FALSE(mask_->covers({300.0f, 240.0f}));
  mask_->add(upright_body());
  for (const auto& [x, y] : {std::pair{300.0f, 240.0f},
                             {300.0f, 130.0f},
                             {325.0f, 450.0f},
                             {275.0f, 350.0f},
                             {410.0f, 220.0f}})
    EXPECT_TRUE(mask_->covers({x, y})) << x << " " << y;
  for (const auto& [x, y] : {std::pair{200.0f, 400.0f},
                             {450.0f, 300.0f},
                             {300.0f, 40.0f},
                             {-1e9f, 0.0f},
                             {std::nanf(""), 300.0f}})
    EXPECT_FALSE(mask_->covers({x, y})) << x << " " << y;
  mask_->begin(kRegion);
  EXPECT_FALSE(mask_->covers({300.0f, 240.0f})) << "of the body before";
}

TEST_F(BodyMaskTest, TurnsWithTheRegion) {
  BodyRegion turned = kRegion;
  turned.turn_rad = 0.7f;
  mask_->begin(turned);
  mask_->add(upright_body());
  EXPECT_TRUE(mask_->covers({300.0f, 240.0f}));
  EXPECT_TRUE(mask_->covers({410.0f, 220.0f}));
  EXPECT_FALSE(mask_->covers({200.0f, 400.0f}));
}

TEST_F(BodyMaskTest, PaintsFromTheLeftOfTheMaskToItsRight) {
  std::vector<float> pixels(3u * kSide * kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      pixels[3 * static_cast<std::size_t>(y * kSide + x)] = static_cast<float>(x) / kSide;
  const std::vector<float> before = pixels;
  mask_->paint_over(pixels);
  EXPECT_EQ(pixels, before) << "nobody is in it";
  SeenBody body = upright_body();
  mask_->add(body);
  std::vector<float> marked = before;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const Eigen::Vector2f place(
          300.0f + (static_cast<float>(x) + 0.5f - 128.0f) * 550.0f / 256.0f,
          300.0f + (static_cast<float>(y) + 0.5f - 128.0f) * 550.0f / 256.0f);
      if (mask_->covers(place)) marked[3 * static_cast<std::size_t>(y * kSide + x)] = 9.0f;
    }
  mask_->paint_over(marked);
  for (std::size_t i = 0; i < marked.size(); i += 3)
    ASSERT_NEAR(marked[i], before[i], 0.03f) << "a ramp is a ramp again, at " << i / 3;
}

TEST_F(BodyMaskTest, SparesWhoIsWishedAndPaintsNothingOfThatOneOverOthers) {
  const SeenBody other = upright_body();
  SeenBody own = upright_body();
  for (Eigen::Vector3f& p : own.image_px) p.x() -= 150.0f;
  mask_->add(other);
  mask_->spare(own);
  EXPECT_FALSE(mask_->covers({150.0f, 240.0f})) << "the own trunk";
  EXPECT_FALSE(mask_->covers({175.0f, 205.0f})) << "the other's arm before it";
  EXPECT_TRUE(mask_->covers({300.0f, 240.0f})) << "the other's trunk";
  // The own body is bright: nothing of it is seen where the other was.
  std::vector<float> pixels(3u * kSide * kSide);
  const auto column = [](float x_px) {
    return static_cast<int>(128.0f + (x_px - 300.0f) * 256.0f / 550.0f);
  };
  for (int y = 0; y < kSide; ++y)
    for (int x = column(90.0f); x < column(210.0f); ++x)
      pixels[3 * static_cast<std::size_t>(y * kSide + x)] = 1.0f;
  mask_->paint_over(pixels);
  const int row = static_cast<int>(128.0f + (240.0f - 300.0f) * 256.0f / 550.0f);
  EXPECT_NEAR(pixels[3 * static_cast<std::size_t>(row * kSide + column(300.0f))], 0.0f, 0.05f);
  EXPECT_EQ(pixels[3 * static_cast<std::size_t>(row * kSide + column(150.0f))], 1.0f);
}

TEST_F(BodyMaskTest, LimbsThatAreGuessedHideNothing) {
  SeenBody body = upright_body();
  body.visibility[index_of(Landmark::kLeftWrist)] = 0.1f;
  mask_->add(body);
  EXPECT_FALSE(mask_->covers({410.0f, 220.0f}));
  EXPECT_TRUE(mask_->covers({190.0f, 220.0f})) << "the other arm";
}

TEST_F(BodyMaskTest, BodiesOfAnyNumbersAreLeftOut) {
  for (const float wild : {std::nanf(""), 1e30f, -1e30f}) {
    SeenBody body = upright_body();
    for (auto& p : body.image_px) p.setConstant(wild);
    mask_->add(body);
    body = upright_body();
    body.next_px[0] = {wild, wild};
    mask_->add(body);
  }
  std::vector<float> pixels(3u * kSide * kSide, 0.25f);
  mask_->paint_over(pixels);
  for (const float p : pixels) ASSERT_EQ(p, 0.25f);
}

}  // namespace
}  // namespace dance
