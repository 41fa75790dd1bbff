// Pictures drawn by the processor, looked at pixel by pixel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "formats/body/guest_look.h"
#include "tests/viewer/dressed_scene.h"
#include "tests/viewer/driver_memory.h"
#include "tests/viewer/test_scene.h"
#include "viewer/gl/offscreen.h"
#include "viewer/stage/stage_painter.h"

namespace dance {
namespace {

using Eigen::Vector3f;
constexpr int kWidth_px = 640;
constexpr int kHeight_px = 360;
constexpr float kAspect = 640.0f / 360.0f;

enum class Dress { kMannequins, kNone };

// The OpenGL context is made once for all tests of this program.
class PictureTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = OffscreenContext::create();
    if (made) {
      context_ = std::move(*made);
      keep_drivers_loaded();
    } else {
      why_not_ = made.error().what;
    }
  }
  static void TearDownTestSuite() {
    painter_.reset();
    context_.reset();
  }
  void SetUp() override {
    if (!context_) GTEST_SKIP() << why_not_;
  }

  static OrbitCamera camera_for(const SceneState& scene, float yaw_rad = 0.0f) {
    std::vector<Vector3f> points;
    for (const SceneGuest& guest : scene.guests) append_outline(guest, points);
    OrbitCamera camera;
    camera.yaw_rad = yaw_rad;
    return frame_points(camera, points, kAspect, 0.86f);
  }

  static Picture draw(const SceneState& scene, const OrbitCamera& camera,
                      const OverlayChoice& choice = {false, false},
                      Quality quality = Quality::kHigh, Dress dress = Dress::kMannequins,
                      const StageLook& look = {}) {
    // Made once for each quality: compiling shaders takes longer than drawing.
    if (!painter_ || painter_->renderer().quality() != quality) make_painter(quality);
    painter_->set_look(look);
    const auto drawn = painter_->draw(dress == Dress::kNone ? scene : dressed(scene), camera,
                                      kWidth_px, kHeight_px, choice);
    EXPECT_TRUE(drawn) << drawn.error().what;
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return painter_->read();
  }
  static Picture draw_comparison(const SceneState& scene, const OrbitCamera& camera) {
    const auto drawn =
        painter_->draw(compare(dressed(scene)), camera, kWidth_px, kHeight_px, {true, true});
    EXPECT_TRUE(drawn) << drawn.error().what;
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return painter_->read();
  }
  static void make_painter(Quality quality) {
    painter_.reset();
    auto made = StagePainter::create(quality, 1.0f);
    ASSERT_TRUE(made) << made.error().what;
    painter_ = std::move(*made);
  }
  static void forget_painter() { painter_.reset(); }

 private:
  static inline std::unique_ptr<OffscreenContext> context_;
  static inline std::string why_not_;
  static inline std::unique_ptr<StagePainter> painter_;
};

SceneState scene_of(SceneGuest guest) {
  SceneState scene;
  scene.guests.push_back(std::move(guest));
  return scene;
}

int difference(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}
int brightness(const std::array<int, 3>& pixel) { return pixel[0] + pixel[1] + pixel[2]; }

// How different a picture with somebody is from the empty stage, at a point of W.
int change_at(const Picture& with, const Picture& without, const OrbitCamera& camera,
              const Vector3f& p_W_m) {
  const auto at = project(camera, p_W_m, kWidth_px, kHeight_px);
  if (!at) return 0;
  const int x = std::clamp(static_cast<int>(at->x_px), 0, kWidth_px - 1);
  const int y = std::clamp(static_cast<int>(at->y_px), 0, kHeight_px - 1);
  return difference(with.at(x, y), without.at(x, y));
}

TEST_F(PictureTest, HasTheBodyWhereTheJointsAreAndTheStageBeside) {
  const SceneState scene = scene_of(guest_in_t_pose("alice"));
  const OrbitCamera camera = camera_for(scene);
  const Picture with = draw(scene, camera);
  const Picture without = draw(SceneState(), camera);
  BodyFrames frames;
  forward_kinematics(scene.guests[0].skeleton, scene.guests[0].pose, frames);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_GT(change_at(with, without, camera, frames.p_WB_m[b]), 20)
        << kBones[b].name << " is in the picture";
  const Vector3f head = frames.tip(Tip::kHead);
  for (const Vector3f& beside :
       {Vector3f(0.5f, 1.0f, 0), Vector3f(-0.5f, 1.0f, 0), Vector3f(0.6f, 1.65f, 0),
        Vector3f(-0.6f, 1.65f, 0), Vector3f(head + Vector3f(0, 0.08f, 0))})
    EXPECT_LT(change_at(with, without, camera, beside), 12)
        << "beside the body at " << beside.transpose();
}

TEST_F(PictureTest, ShowsBothSidesOfAComparisonAndTheBeatsUnderThem) {
  SceneState scene = scene_of(guest_in_t_pose("alice"));
  scene.music = SceneMusic{20.3, 3.0, 4};
  SceneGuest bob = guest_in_t_pose("bob");
  bob.pose.p_WH_m.x() += 1.0f;
  BeatMeter meter;
  for (int i = 0; i < 120; ++i) {
    const double heard = 14.0 + 0.05 * i;
    meter.add(heard - 0.4, heard, 3.0, Duration::ms(133));
  }
  bob.figures.beat = meter.figures();
  SceneGuest twin = bob;
  twin.id = *GuestId::parse("bob-raw");
  twin.pose.p_WH_m.x() += 0.5f;
  scene.guests.push_back(bob);
  scene.guests.push_back(twin);
  const OrbitCamera camera = camera_for(scene);
  draw(SceneState(), camera);  // makes the painter
  const Picture picture = draw_comparison(scene, camera);
  ASSERT_EQ(picture.width_px, kWidth_px);
  ASSERT_EQ(picture.height_px, kHeight_px);
  // Alice stands in both halves alike, bob does not.
  int alike = 0, unlike = 0, panel = 0;
  for (int y = 0; y < kHeight_px; ++y)
    for (int x = 2; x < kWidth_px / 2 - 2; ++x) {
      const int off = difference(picture.at(x, y), picture.at(x + kWidth_px / 2, y));
      (off < 12 ? alike : unlike) += 1;
      if (y > kHeight_px - 60) panel += brightness(picture.at(x, y)) > 300 ? 1 : 0;
    }
  EXPECT_GT(alike, 20 * kHeight_px);
  EXPECT_GT(unlike, 500);
  EXPECT_GT(panel, 200) << "the ruler, the names and the dots";
  // The same on both sides is the same picture twice, but for the words below.
  scene.guests[2].pose = scene.guests[1].pose;
  const Picture same = draw_comparison(scene, camera);
  int differs = 0;
  for (int y = 0; y < kHeight_px / 2; ++y)
    for (int x = 2; x < kWidth_px / 2 - 2; ++x)
      differs += difference(same.at(x, y), same.at(x + kWidth_px / 2, y)) > 12 ? 1 : 0;
  EXPECT_EQ(differs, 0);
}

TEST_F(PictureTest, ShowsAllOfThirtyDancers) {
  const SceneState scene = full_floor();
  OrbitCamera camera = camera_for(scene);
  camera.pitch_rad = 0.9f;
  std::vector<Vector3f> points;
  for (const SceneGuest& guest : scene.guests) append_outline(guest, points);
  camera = frame_points(camera, points, kAspect, 0.9f);
  const Picture all = draw(scene, camera, {false, false}, Quality::kLow);
  // A guest who is left out leaves a gap where the head was; every third leaves at a time.
  for (std::size_t first = 0; first < 3; ++first) {
    SceneState others = scene;
    for (std::size_t i = first; i < scene.guests.size(); i += 3) others.guests[i].opacity = 0.0f;
    const Picture without = draw(others, camera, {false, false}, Quality::kLow);
    for (std::size_t i = first; i < scene.guests.size(); i += 3)
      EXPECT_GT(
          change_at(all, without, camera, tag_anchor_W_m(scene.guests[i]) - Vector3f(0, 0.2f, 0)),
          20)
          << scene.guests[i].id.view();
  }
}

TEST_F(PictureTest, DarkensTheFloorBesideFeetAndUnderTheShadow) {
  const SceneState scene = scene_of(guest_in_t_pose("alice"));
  OrbitCamera camera = camera_for(scene);
  camera.pitch_rad = 0.5f;
  std::vector<Vector3f> points;
  append_outline(scene.guests[0], points);
  camera = frame_points(camera, points, kAspect, 0.5f);
  const Picture with = draw(scene, camera);
  const Picture without = draw(SceneState(), camera);
  const auto darkening = [&](const Vector3f& p) {
    const auto at = project(camera, p, kWidth_px, kHeight_px);
    const int x = static_cast<int>(at->x_px);
    const int y = static_cast<int>(at->y_px);
    return brightness(without.at(x, y)) - brightness(with.at(x, y));
  };
  EXPECT_GT(darkening({0.0f, 0.0f, 0.05f}), 25) << "between the feet";
  EXPECT_GT(darkening({-0.19f, 0.0f, 0.03f}), 20) << "beside the right foot";
  EXPECT_LT(std::abs(darkening({1.3f, 0.0f, 0.6f})), 12) << "far from the feet the floor is lit";
  // Along the light, half a body's height: the cast shadow of the trunk.
  int deepest = 0;
  for (float along = 0.3f; along < 1.0f; along += 0.05f)
    for (float side = -0.6f; side <= 0.6f; side += 0.05f)
      deepest = std::max(deepest, darkening({side, 0.0f, -along}));
  EXPECT_GT(deepest, 60) << "behind the dancer lies a shadow";
}

TEST_F(PictureTest, IsTheSameTwice) {
  const SceneState scene = couple();
  const OrbitCamera camera = camera_for(scene, 0.4f);
  const Picture first = draw(scene, camera, {true, true});
  forget_painter();
  const Picture second = draw(scene, camera, {true, true});
  EXPECT_TRUE(first.rgb == second.rgb);
}

TEST_F(PictureTest, HangsTheNameOverTheHead) {
  const SceneState scene = scene_of(guest_at_ease("alice", Vector3f::Zero(), 0.0f));
  const OrbitCamera camera = camera_for(scene);
  const Picture with = draw(scene, camera, {true, false});
  const Picture without = draw(scene, camera, {false, false});
  const auto anchor = project(camera, tag_anchor_W_m(scene.guests[0]), kWidth_px, kHeight_px);
  ASSERT_TRUE(anchor);
  int changed = 0;
  int changed_elsewhere = 0;
  int brightest = 0;
  for (int y = 0; y < kHeight_px; ++y)
    for (int x = 0; x < kWidth_px; ++x) {
      if (with.at(x, y) == without.at(x, y)) continue;
      const bool is_near = std::abs(static_cast<float>(x) - anchor->x_px) < 60.0f &&
                           static_cast<float>(y) < anchor->y_px + 10.0f &&
                           static_cast<float>(y) > anchor->y_px - 40.0f;
      ++(is_near ? changed : changed_elsewhere);
      brightest = std::max(brightest, brightness(with.at(x, y)));
    }
  EXPECT_GT(changed, 400);
  EXPECT_EQ(changed_elsewhere, 0);
  EXPECT_GT(brightest, 600) << "light letters on a dark ground";
}

TEST_F(PictureTest, ShowsTheFaceToThoseInFront) {
  SceneGuest guest = guest_at_ease("alice", Vector3f::Zero(), 0.0f);
  const Vector3f skin = srgb_from_linear(look_of(guest.id).skin);
  const auto skin_pixels_of_head = [&](float yaw_rad) {
    const SceneState scene = scene_of(guest);
    OrbitCamera camera;
    camera.yaw_rad = yaw_rad;
    camera.pitch_rad = 0.0f;
    BodyFrames frames;
    forward_kinematics(guest.skeleton, guest.pose, frames);
    camera.target_W_m = frames.position(Bone::kHead) + Vector3f(0, 0.1f, 0);
    camera.distance_m = 1.0f;
    const Picture picture = draw(scene, camera);
    int count = 0;
    for (int y = kHeight_px / 2 - 60; y < kHeight_px / 2 + 40; ++y)
      for (int x = kWidth_px / 2 - 60; x < kWidth_px / 2 + 60; ++x) {
        const auto pixel = picture.at(x, y);
        // Skin is bright and more red than blue; hair is not.
        count += pixel[0] > static_cast<int>(110.0f * skin.x()) && pixel[0] > pixel[2] + 12;
      }
    return count;
  };
  const int front = skin_pixels_of_head(0.0f);
  const int back = skin_pixels_of_head(3.14159f);
  EXPECT_GT(front, 4000);
  EXPECT_LT(back, front / 4);
}

TEST_F(PictureTest, GivesGuestsColoursOfTheirOwn) {
  const GuestLook alice = look_of(*GuestId::parse("alice"));
  const GuestLook again = look_of(*GuestId::parse("alice"));
  const GuestLook bob = look_of(*GuestId::parse("bob"));
  EXPECT_EQ(alice.top, again.top);
  EXPECT_NE(alice.top, bob.top);
}

TEST_F(PictureTest, FadesAGuestWithoutATrace) {
  SceneGuest guest = guest_in_t_pose("alice");
  const OrbitCamera camera = camera_for(scene_of(guest));
  const auto changed_pixels = [&](float opacity) {
    guest.opacity = opacity;
    const Picture with = draw(scene_of(guest), camera);
    const Picture without = draw(SceneState(), camera);
    int count = 0;
    for (int y = 0; y < kHeight_px; ++y)
      for (int x = 0; x < kWidth_px; ++x) count += difference(with.at(x, y), without.at(x, y)) > 40;
    return count;
  };
  const int solid = changed_pixels(1.0f);
  const int half = changed_pixels(0.5f);
  EXPECT_GT(solid, 3000);
  EXPECT_LT(half, solid * 3 / 4);
  EXPECT_GT(half, solid / 4);
  EXPECT_EQ(changed_pixels(0.0f), 0);
}

TEST_F(PictureTest, KeepsThePlainDrawingCloseToTheFine) {
  const SceneState scene = couple();
  const OrbitCamera camera = camera_for(scene);
  const Picture fine = draw(scene, camera, {false, false}, Quality::kHigh);
  const Picture plain = draw(scene, camera, {false, false}, Quality::kLow);
  double sum = 0.0;
  for (std::size_t i = 0; i < fine.rgb.size(); ++i) sum += std::abs(fine.rgb[i] - plain.rgb[i]);
  EXPECT_LT(sum / static_cast<double>(fine.rgb.size()), 6.0);
}

// Bends of knees, hips and elbows: the figure's own joints lie on its pixels, and no farther from
// its outline than a limb is thick.
TEST_F(PictureTest, HasTheJointsOfADancingCoupleOnItsFigures) {
  const SceneState scene = dressed(couple());
  FigurePoser poser;
  for (const Quality quality : {Quality::kHigh, Quality::kLow}) {
    const OrbitCamera camera = camera_for(scene, 0.3f);
    const Picture with = draw(scene, camera, {false, false}, quality);
    const Picture without = draw(SceneState(), camera, {false, false}, quality);
    for (const PosedFigure& figure : poser.pose(scene))
      for (std::size_t b = 0; b < kBoneCount; ++b)
        EXPECT_GT(change_at(with, without, camera, figure.frames.p_WB_m[b]), 20)
            << figure.id.view() << "'s " << kBones[b].name;
  }
}

TEST_F(PictureTest, ShowsWhereAGuestIsWhoseFigureIsNotReady) {
  const SceneGuest guest = guest_in_t_pose("alice");
  const OrbitCamera camera = camera_for(scene_of(guest));
  const Picture with = draw(scene_of(guest), camera, {false, false}, Quality::kHigh, Dress::kNone);
  const Picture without = draw(SceneState(), camera);
  EXPECT_GT(change_at(with, without, camera, Vector3f(0.36f, 0, 0)), 30) << "a ring on the floor";
  EXPECT_LT(change_at(with, without, camera, Vector3f(0, 1.2f, 0)), 12) << "and nobody in it";
}

TEST_F(PictureTest, PulsesOnTheBeatWhereMusicPlays) {
  SceneState scene;
  const OrbitCamera camera = camera_for(scene_of(guest_in_t_pose("alice")));
  const Picture silent = draw(scene, camera);
  const auto brighter_by = [&](double beats) {
    scene.music = SceneMusic{beats, 2.0, 4};
    const Picture picture = draw(scene, camera);
    const auto at = project(camera, Vector3f(0.2f, 0, 0.2f), kWidth_px, kHeight_px);
    const int x = static_cast<int>(at->x_px), y = static_cast<int>(at->y_px);
    return brightness(picture.at(x, y)) - brightness(silent.at(x, y));
  };
  EXPECT_GT(brighter_by(4.0), brighter_by(5.0));
  EXPECT_GT(brighter_by(5.0), brighter_by(5.6) + 5);
  EXPECT_LT(brighter_by(4.0), 150) << "seen beside the dance, and not instead of it";
}

TEST_F(PictureTest, DrawsTrailsOfHandsOnDemandOnly) {
  SceneState scene = scene_of(guest_at_ease("alice", Vector3f::Zero(), 0.0f));
  const OrbitCamera camera = camera_for(scene_of(guest_in_t_pose("alice")));
  const auto trail_pixels = [&](bool has_trails) {
    StageLook look;
    look.trails = has_trails;
    look.pulse = false;
    const Vector3f home = scene.guests[0].pose.p_WH_m;
    Picture with;
    for (int i = 0; i <= 20; ++i) {
      scene.time = MonoTime::from_us(1'000'000 + 20'000 * i);
      scene.guests[0].pose.p_WH_m = home + Vector3f(-0.03f * static_cast<float>(20 - i), 0, 0);
      with = draw(scene, camera, {false, false}, Quality::kHigh, Dress::kMannequins, look);
    }
    scene.guests[0].pose.p_WH_m = home;
    const Picture plain = draw(scene, camera);
    int changed = 0;
    for (int y = 0; y < kHeight_px; ++y)
      for (int x = 0; x < kWidth_px; ++x) changed += difference(with.at(x, y), plain.at(x, y)) > 25;
    return changed;
  };
  EXPECT_GT(trail_pixels(true), 400);
  EXPECT_LT(trail_pixels(false), 40);
}

TEST_F(PictureTest, ChangesSizeWithoutARestart) {
  const SceneState scene = couple();
  const OrbitCamera camera = camera_for(scene);
  forget_painter();  // ImGui has one context per process
  auto painter = StagePainter::create(Quality::kLow, 1.0f);
  ASSERT_TRUE(painter) << painter.error().what;
  for (const auto& [width, height] :
       {std::pair{320, 200}, std::pair{64, 640}, std::pair{320, 200}}) {
    ASSERT_TRUE((*painter)->draw(scene, camera, width, height, {}));
    const Picture picture = (*painter)->read();
    EXPECT_EQ(picture.width_px, width);
    EXPECT_EQ(picture.height_px, height);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }
}

}  // namespace
}  // namespace dance
