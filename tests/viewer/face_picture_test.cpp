// A mannequin's face in close-up: an expression changes only its part of the picture, and equal
// moments give equal pictures.
#include <gtest/gtest.h>

#include "tests/viewer/dressed_scene.h"
#include "tests/viewer/offscreen_test.h"
#include "tests/viewer/test_scene.h"
#include "viewer/stage/stage_painter.h"

namespace dance {
namespace {

using Eigen::Vector3f;

class FacePictureTest : public OffscreenTest {
 protected:
  static constexpr int kSide_px = 240;
  static constexpr float kSide_m = 0.3f;

  void SetUp() override {
    OffscreenTest::SetUp();
    if (IsSkipped()) return;
    auto made = StagePainter::create(Quality::kHigh, 1.0f);
    ASSERT_TRUE(made) << made.error().what;
    painter_ = std::move(*made);
    guest_ = guest_at_ease("alice", Vector3f::Zero(), 0.0f);
    guest_.face.emplace();
    guest_.face->presence = kFaceSeen | kGazeSeen;
  }
  void TearDown() override { painter_.reset(); }

  // The head fills the picture.
  Picture draw(const Face& face) {
    SceneState scene;
    scene.time = MonoTime::from_us(5'000'000);
    guest_.face = face;
    scene.guests.push_back(guest_);
    OrbitCamera camera;
    camera.target_W_m = head_m();
    camera.pitch_rad = camera.yaw_rad = 0.0f;
    camera.distance_m = 3.0f;
    camera.fov_y_rad = 2.0f * std::atan(0.5f * kSide_m / camera.distance_m);
    const auto drawn = painter_->draw(dressed(scene), camera, kSide_px, kSide_px, {false, false});
    EXPECT_TRUE(drawn) << drawn.error().what;
    return painter_->read();
  }
  Face neutral() const { return *guest_.face; }

  // Pixels that differ, from `low_m` to `high_m` above the head's joint.
  static int changed(const Picture& a, const Picture& b, float low_m, float high_m) {
    constexpr float kMiddle_m = 0.1f;  // of the picture, above the joint
    int count = 0;
    for (int y = 0; y < kSide_px; ++y) {
      const float at_m = kMiddle_m + kSide_m * (0.5f - (static_cast<float>(y) + 0.5f) / kSide_px);
      if (at_m < low_m || at_m >= high_m) continue;
      for (int x = 0; x < kSide_px; ++x) {
        const auto p = a.at(x, y), q = b.at(x, y);
        const int off = std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]);
        count += off > 24 ? 1 : 0;
      }
    }
    return count;
  }

 private:
  Vector3f head_m() const {
    BodyFrames frames;
    forward_kinematics(guest_.skeleton, guest_.pose, frames);
    return frames.position(Bone::kHead) + Vector3f(0.0f, 0.1f, 0.0f);
  }

  std::unique_ptr<StagePainter> painter_;
  SceneGuest guest_;
};

TEST_F(FacePictureTest, AnExpressionChangesItsPartOfTheFace) {
  using E = Expression;
  const Picture rest = draw(neutral());
  Face smile = neutral(), blink = neutral(), aside = neutral(), open = neutral();
  smile[E::kMouthSmileLeft] = smile[E::kMouthSmileRight] = 0.8f;
  blink[E::kEyeBlinkLeft] = blink[E::kEyeBlinkRight] = 1.0f;
  aside.gaze_rad = {0.5f, 0.0f};
  open[E::kJawOpen] = 0.8f;
  for (const Face& mouth : {smile, open}) {
    const Picture shown = draw(mouth);
    EXPECT_GT(changed(rest, shown, 0.0f, 0.06f), 60);
    EXPECT_EQ(changed(rest, shown, 0.13f, 0.25f), 0) << "above the brows";
  }
  for (const Face& eyes : {blink, aside}) {
    const Picture shown = draw(eyes);
    EXPECT_GT(changed(rest, shown, 0.07f, 0.11f), 40);
    EXPECT_EQ(changed(rest, shown, 0.0f, 0.055f), 0) << "the mouth";
  }
}

TEST_F(FacePictureTest, TheSameMomentIsTheSamePicture) {
  Face face = neutral();
  face[Expression::kJawOpen] = 0.5f;
  const Picture once = draw(face);
  draw(neutral());
  EXPECT_EQ(changed(once, draw(face), -1.0f, 1.0f), 0);
}

}  // namespace
}  // namespace dance
