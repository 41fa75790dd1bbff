// Pictures of places: no OpenGL errors, the same picture each time, and visible dancers.

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/viewer/dressed_scene.h"
#include "tests/viewer/offscreen_test.h"
#include "tests/viewer/test_scene.h"
#include "viewer/stage/stage_painter.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr int kPlaceWidth_px = 480, kPlaceHeight_px = 270;

class PlacePicture : public OffscreenTest {
 protected:
  void TearDown() override { painter_.reset(); }

  void begin(Quality quality) {
    painter_.reset();  // ImGui has one context per process
    auto made = StagePainter::create(quality, 1.0f);
    ASSERT_TRUE(made) << made.error().what;
    painter_ = std::move(*made);
  }
  Picture draw(Venue place, const SceneState& scene, const OrbitCamera& camera) {
    painter_->set_place(place);
    const auto drawn =
        painter_->draw(dressed(scene), camera, kPlaceWidth_px, kPlaceHeight_px, {false, false});
    EXPECT_TRUE(drawn) << drawn.error().what;
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << name_of(place);
    return painter_->read();
  }

  std::unique_ptr<StagePainter> painter_;
};

OrbitCamera camera_before(const SceneState& scene, float yaw_rad = 0.3f) {
  std::vector<Vector3f> points;
  for (const SceneGuest& guest : scene.guests) append_outline(guest, points);
  OrbitCamera camera;
  camera.yaw_rad = yaw_rad;
  return frame_points(camera, points, 480.0f / 270.0f, 0.86f);
}

SceneState with_music(SceneState scene, double beats, int beats_per_bar) {
  scene.music = SceneMusic{beats, 2.0, beats_per_bar};
  return scene;
}

double mean_light(const Picture& picture) {
  double sum = 0.0;
  for (const std::uint8_t value : picture.rgb) sum += value;
  return sum / static_cast<double>(picture.rgb.size());
}

int difference_at(const Picture& a, const Picture& b, const OrbitCamera& camera,
                  const Vector3f& p_W) {
  const auto at = project(camera, p_W, kPlaceWidth_px, kPlaceHeight_px);
  if (!at) return 0;
  const int x = static_cast<int>(at->x_px), y = static_cast<int>(at->y_px);
  if (x < 0 || y < 0 || x >= kPlaceWidth_px || y >= kPlaceHeight_px) return 0;
  const auto one = a.at(x, y), other = b.at(x, y);
  return std::abs(one[0] - other[0]) + std::abs(one[1] - other[1]) + std::abs(one[2] - other[2]);
}

TEST_F(PlacePicture, IsNeitherBlackNorWhiteFromAnywhereInEachQuality) {
  const SceneState scene = with_music(couple(), 8.4, 4);
  for (const Quality quality : {Quality::kLow, Quality::kHigh}) {
    begin(quality);
    for (const PlaceName& it : kPlaceNames)
      for (const float yaw : {0.0f, 1.6f, 3.1f, 4.7f})
        for (const float far : {0.5f, 1.0f, 4.0f}) {
          OrbitCamera camera = camera_before(scene, yaw);
          camera.distance_m *= far;
          camera.pitch_rad = far > 2.0f ? 0.9f : 0.1f;
          const double light = mean_light(draw(it.place, scene, camera));
          EXPECT_GT(light, 8.0) << it.option << " at " << yaw << ", " << far;
          EXPECT_LT(light, 170.0) << it.option << " at " << yaw << ", " << far;
        }
  }
}

TEST_F(PlacePicture, IsTheSameForTheSameMoment) {
  const SceneState scene = with_music(couple(), 8.4, 4);
  const OrbitCamera camera = camera_before(scene);
  for (const PlaceName& it : kPlaceNames) {
    begin(Quality::kHigh);
    const Picture first = draw(it.place, scene, camera);
    begin(Quality::kHigh);
    draw(next_place(it.place, 1), scene, camera);  // whatever was shown before
    EXPECT_TRUE(draw(it.place, scene, camera).rgb == first.rgb) << it.option;
  }
}

TEST_F(PlacePicture, ShowsTheJointsOfDancers) {
  const SceneState scene = couple();
  const OrbitCamera camera = camera_before(scene);
  for (const Quality quality : {Quality::kLow, Quality::kHigh}) {
    begin(quality);
    for (const PlaceName& it : kPlaceNames) {
      const Picture with = draw(it.place, scene, camera);
      const Picture without = draw(it.place, SceneState(), camera);
      int seen = 0, all = 0;
      for (const SceneGuest& guest : scene.guests) {
        BodyFrames frames;
        forward_kinematics(guest.skeleton, guest.pose, frames);
        for (const Vector3f& p : frames.p_WB_m) {
          ++all;
          seen += difference_at(with, without, camera, p) > 20 ? 1 : 0;
        }
      }
      EXPECT_GT(seen, all * 85 / 100) << it.option;
    }
  }
}

TEST_F(PlacePicture, ShowsDancersInTheMirrorOfTheStudio) {
  SceneState scene;
  scene.guests.push_back(guest_at_ease("alice", Vector3f(1.2f, 0.0f, -1.0f), 0.0f));
  OrbitCamera camera;
  camera.yaw_rad = -0.35f;
  camera.target_W_m = Vector3f(1.0f, 1.1f, -3.0f);
  camera.distance_m = 7.0f;
  const float mirror_z = PlaceRoom().back_m;
  for (const Quality quality : {Quality::kLow, Quality::kHigh}) {
    begin(quality);
    const Picture with = draw(Venue::kStudio, scene, camera);
    const Picture without = draw(Venue::kStudio, SceneState(), camera);
    int changed = 0;
    for (const float y : {0.9f, 1.1f, 1.3f})
      changed += difference_at(with, without, camera, Vector3f(1.2f, y, 2.0f * mirror_z + 1.0f));
    EXPECT_GT(changed, 60) << "trunk, where it is seen in the mirror";
  }
}

TEST_F(PlacePicture, BreathesWithTheBarWhereBarsAreKnown) {
  const OrbitCamera camera = camera_before(couple());
  begin(Quality::kLow);
  // The wall above the dancers, where no ring of the beat runs.
  const auto light_at = [&](Venue place, double beats, int beats_per_bar) {
    const Picture picture = draw(place, with_music({}, beats, beats_per_bar), camera);
    double sum = 0.0;
    for (int y = 0; y < kPlaceHeight_px / 5; ++y)
      for (int x = 0; x < kPlaceWidth_px; ++x)
        for (const int value : picture.at(x, y)) sum += value;
    return sum;
  };
  for (const Venue place : {Venue::kStudio, Venue::kBar}) {
    EXPECT_GT(light_at(place, 8.0, 4), 1.01 * light_at(place, 10.0, 4)) << name_of(place);
    EXPECT_EQ(light_at(place, 8.0, 0), light_at(place, 10.0, 0)) << name_of(place);
  }
}

TEST_F(PlacePicture, LeavesThePlainStageAsItWas) {
  const SceneState scene = couple();
  const OrbitCamera camera = camera_before(scene);
  begin(Quality::kHigh);
  const Picture before = draw(Venue::kPlain, scene, camera);
  for (const PlaceName& it : kPlaceNames) draw(it.place, scene, camera);
  EXPECT_TRUE(draw(Venue::kPlain, scene, camera).rgb == before.rgb);
}

}  // namespace
}  // namespace dance
