// The stage as two eyes see it, drawn by the processor and looked at pixel by pixel.
#include "headset/stereo/stereo_painter.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/viewer/dressed_scene.h"
#include "tests/viewer/offscreen_test.h"
#include "tests/viewer/test_scene.h"
#include "viewer/gl/picture.h"

namespace dance {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr int kEyeWidth_px = 300, kEyeHeight_px = 320;
constexpr float kEyesApart_m = 0.064f;
constexpr EyeTangents kOpen{-1.0f, 1.0f, 1.0f, -1.0f};
const Vector3f kBetweenEyes_m(0.0f, 1.6f, 0.0f);

struct Eyes {
  Picture left, right;
};

int unlike(const Picture& a, const Picture& b, int x, int y) {
  const auto p = a.at(x, y), q = b.at(x, y);
  return std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]);
}

// Where two pictures of an eye differ: how many pixels, and the mean of their columns.
struct Change {
  int pixels = 0;
  double x_px = 0.0;
};
Change change_between(const Picture& a, const Picture& b) {
  Change change;
  for (int y = 0; y < kEyeHeight_px; ++y)
    for (int x = 0; x < kEyeWidth_px; ++x)
      if (unlike(a, b, x, y) > 30) ++change.pixels, change.x_px += x;
  if (change.pixels > 0) change.x_px /= change.pixels;
  return change;
}

class StereoPicture : public OffscreenTest {
 protected:
  void SetUp() override {
    OffscreenTest::SetUp();
    if (IsSkipped()) return;
    auto made = StereoPainter::create(Quality::kLow, Language::kEnglish);
    ASSERT_TRUE(made) << made.error().what;
    painter_ = std::move(*made);
    painter_->renderer().build_meshes(MeshMaker::When::kAtOnce);
    wishes_.own = *GuestId::parse("own");
    wishes_.tags = false;
  }
  void TearDown() override { painter_.reset(); }

  // Looks along -Z.
  static std::array<StageEye, 2> eyes_at(const Vector3f& middle_m) {
    std::array<StageEye, 2> eyes;
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const Vector3f aside((i == 0 ? -0.5f : 0.5f) * kEyesApart_m, 0.0f, 0.0f);
      eyes[i] = eye_at(middle_m + aside, Matrix3f::Identity(), kOpen, kEyeHeight_px);
    }
    return eyes;
  }
  Picture read(std::size_t eye) {
    painter_->paint(eye);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, painter_->finished().name());
    return read_bound_framebuffer(kEyeWidth_px, kEyeHeight_px);
  }
  Eyes draw(SceneState scene) {
    scene = dressed(scene);
    const auto prepared = painter_->prepare(scene, eyes_at(kBetweenEyes_m), kEyeWidth_px,
                                            kEyeHeight_px, panel_, words_, wishes_);
    EXPECT_TRUE(prepared) << prepared.error().what;
    Eyes eyes;
    eyes.right = read(1);
    eyes.left = read(0);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return eyes;
  }
  static SceneState with(const SceneGuest& guest) {
    SceneState scene;
    scene.guests.push_back(guest);
    return scene;
  }
  static SceneGuest other_at(float z_m) {
    return guest_at_ease("bob", Vector3f(0.0f, 0.0f, z_m), 0.0f);
  }
  // The back of the left wrist 40 cm before the eyes.
  void look_at_panel() {
    WristPanel::Input input;
    input.eyes_W_m = kBetweenEyes_m;
    Eigen::Isometry3f grip = Eigen::Isometry3f::Identity();
    grip.linear().col(0) = -Vector3f::UnitZ();
    grip.linear().col(1) = -Vector3f::UnitX();
    grip.linear().col(2) = Vector3f::UnitY();
    grip.translation() = kBetweenEyes_m - Vector3f(WristPanel::kTowardsFingers_m, 0.0f,
                                                   0.4f + WristPanel::kOverBack_m);
    input.left_grip_W = grip;
    for (int i = 1; i < 60; ++i) panel_.update(input, MonoTime() + Duration::ms(20 * i));
    ASSERT_EQ(panel_.opacity(), 1.0f);
  }

  std::unique_ptr<StereoPainter> painter_;
  WristPanel panel_;
  PanelWords words_;
  StereoWishes wishes_;
};

TEST_F(StereoPicture, WhatIsNearIsFurtherRightForTheLeftEyeAndWhatIsFarHardly) {
  const Eyes empty = draw({});
  double last_px = 1e9;
  for (const float distance_m : {1.0f, 2.0f, 6.0f}) {
    const Eyes eyes = draw(with(other_at(-distance_m)));
    const Change left = change_between(eyes.left, empty.left);
    const Change right = change_between(eyes.right, empty.right);
    ASSERT_GT(left.pixels, 100) << distance_m;
    ASSERT_GT(right.pixels, 100) << distance_m;
    const double parallax_px = left.x_px - right.x_px;
    const auto wanted_px = static_cast<double>(0.5f * kEyeWidth_px * kEyesApart_m / distance_m);
    EXPECT_NEAR(parallax_px, wanted_px, 0.35 * wanted_px + 0.7) << distance_m;
    EXPECT_GT(parallax_px, 0.0) << distance_m;
    EXPECT_LT(parallax_px, last_px);
    last_px = parallax_px;
  }
}

TEST_F(StereoPicture, TheOwnHeadIsNotInTheWayAndTheOwnBodyIsThere) {
  const SceneState scene = with(other_at(-1.0f));
  const Eyes empty = draw({});
  BodyFrames frames;
  forward_kinematics(scene.guests[0].skeleton, scene.guests[0].pose, frames);
  const StageEye left = eyes_at(kBetweenEyes_m)[0];
  const auto change_at = [&](const Eyes& eyes, const Vector3f& p_W_m) {
    const Vector3f at = (left.clip_from_world * p_W_m.homogeneous()).hnormalized();
    const int x = static_cast<int>(0.5f * (1.0f + at.x()) * kEyeWidth_px);
    const int y = static_cast<int>(0.5f * (1.0f - at.y()) * kEyeHeight_px);
    return unlike(eyes.left, empty.left, x, y);
  };
  const Vector3f face = 0.5f * (frames.position(Bone::kHead) + frames.tip(Tip::kHead));
  const Vector3f chest = frames.position(Bone::kChest);
  const Eyes of_another = draw(scene);
  EXPECT_GT(change_at(of_another, face), 30);
  EXPECT_GT(change_at(of_another, chest), 30);
  wishes_.own = scene.guests[0].id;
  const Eyes of_own = draw(scene);
  EXPECT_LT(change_at(of_own, face), 10);
  EXPECT_GT(change_at(of_own, chest), 30);
}

TEST_F(StereoPicture, WhoComesTooNearFadesAway) {
  const Eyes empty = draw({});
  wishes_.comfort.personal_space_m = 0.45f;
  const int at_arms_length = change_between(draw(with(other_at(-0.6f))).left, empty.left).pixels;
  EXPECT_GT(at_arms_length, 5000);
  EXPECT_LT(change_between(draw(with(other_at(-0.12f))).left, empty.left).pixels, 200);
  wishes_.comfort.personal_space_m = 0.0f;
  EXPECT_GT(change_between(draw(with(other_at(-0.12f))).left, empty.left).pixels, 5000);
}

TEST_F(StereoPicture, EachPlaceShowsTheOtherDancerInBothEyes) {
  for (const PlaceName& it : kPlaceNames) {
    wishes_.place = it.place;
    const Eyes empty = draw({});
    const Eyes eyes = draw(with(other_at(-2.0f)));
    EXPECT_GT(change_between(eyes.left, empty.left).pixels, 300) << it.option;
    EXPECT_GT(change_between(eyes.right, empty.right).pixels, 300) << it.option;
  }
}

TEST_F(StereoPicture, NamesAreOverHeadsInBothEyes) {
  const SceneState scene = with(other_at(-2.0f));
  const Eyes without = draw(scene);
  wishes_.tags = true;
  const Eyes tagged = draw(scene);
  const Vector3f over = tag_anchor_W_m(scene.guests[0]) + Vector3f(0.0f, 0.1f, 0.0f);
  const std::array<StageEye, 2> eyes = eyes_at(kBetweenEyes_m);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const Change change =
        change_between(i == 0 ? tagged.left : tagged.right, i == 0 ? without.left : without.right);
    EXPECT_GT(change.pixels, 60) << i;
    const Vector3f at = (eyes[i].clip_from_world * over.homogeneous()).hnormalized();
    EXPECT_NEAR(change.x_px, static_cast<double>(0.5f * (at.x() + 1.0f) * kEyeWidth_px), 4.0) << i;
  }
  // The own name is not read by its dancer.
  wishes_.own = scene.guests[0].id;
  const Eyes own = draw(scene);
  wishes_.tags = false;
  EXPECT_EQ(change_between(own.left, draw(scene).left).pixels, 0);
}

TEST_F(StereoPicture, ThePanelIsReadBeforeAllElseAndChangesWithItsWords) {
  const SceneState scene = with(other_at(-0.5f));  // nearer than the panel's middle is not
  const Eyes without = draw(scene);
  look_at_panel();
  words_.title = "own";
  const Eyes shown = draw(scene);
  // 20 cm by 14 cm, 40 cm away.
  const int wanted = static_cast<int>(0.5f * kEyeWidth_px * 0.5f * 0.5f * kEyeHeight_px * 0.35f);
  EXPECT_GT(change_between(shown.left, without.left).pixels, wanted * 7 / 10);
  EXPECT_GT(change_between(shown.right, without.right).pixels, wanted * 7 / 10);
  EXPECT_GT(change_between(shown.left, without.left).x_px,
            change_between(shown.right, without.right).x_px + 10.0);
  words_.title = "somebody else";
  words_.advice = PanelWords::Advice::kStandInTPose;
  EXPECT_GT(change_between(draw(scene).left, shown.left).pixels, 30);
}

TEST_F(StereoPicture, ADarkPictureIsBlackAndAHalfDarkOneHalfSo) {
  const SceneState scene = with(other_at(-1.5f));
  const auto light_of = [](const Picture& picture) {
    long sum = 0;
    for (const std::uint8_t value : picture.rgb) sum += value;
    return sum;
  };
  const long light = light_of(draw(scene).left);
  ASSERT_GT(light, 0);
  wishes_.darkness = 0.5f;
  const long half = light_of(draw(scene).left);
  EXPECT_LT(half, light);
  EXPECT_GT(half, 0);
  wishes_.darkness = 1.0f;
  const Eyes dark = draw(scene);
  // Dither leaves a step.
  for (const Picture* picture : {&dark.left, &dark.right})
    for (const std::uint8_t value : picture->rgb) ASSERT_LE(value, 1);
}

TEST_F(StereoPicture, IsCopiedAsItIsIntoAnImageOfTheHeadset) {
  const Picture left = draw(with(other_at(-1.5f))).left;
  const GlTexture image = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, image.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, kEyeWidth_px, kEyeHeight_px, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, nullptr);
  painter_->copy_to(image.name());
  const GlFramebuffer look = GlFramebuffer::make();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, look.name());
  glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, image.name(), 0);
  EXPECT_EQ(read_bound_framebuffer(kEyeWidth_px, kEyeHeight_px).rgb, left.rgb);
}

}  // namespace
}  // namespace dance
