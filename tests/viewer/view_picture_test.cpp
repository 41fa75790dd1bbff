// Pictures of views: what the pixels say.

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/viewer/dressed_scene.h"
#include "tests/viewer/driver_memory.h"
#include "tests/viewer/test_scene.h"
#include "viewer/gl/offscreen.h"
#include "viewer/stage/stage_painter.h"
#include "viewer/view/view_director.h"

namespace dance {
namespace {

constexpr int kViewWidth_px = 480;
constexpr int kViewHeight_px = 300;
constexpr ViewDirector::Size kPictureSize{kViewWidth_px, kViewHeight_px, 60};

OverlayChoice no_words() {
  OverlayChoice choice;
  choice.tags = choice.hud = false;
  return choice;
}

class ViewPicture : public testing::Test {
 protected:
  void SetUp() override {
    auto context = OffscreenContext::create();
    if (!context) GTEST_SKIP() << context.error().what;
    context_ = std::move(*context);
    keep_drivers_loaded();
    auto painter = StagePainter::create(Quality::kLow, 1.0f);
    ASSERT_TRUE(painter) << painter.error().what;
    painter_ = std::move(*painter);
  }

  Picture draw(const SceneState& scene, const OrbitCamera& camera,
               const OverlayChoice& choice = no_words()) {
    EXPECT_TRUE(painter_->draw(scene, camera, kViewWidth_px, kViewHeight_px, choice));
    return painter_->read();
  }

  std::unique_ptr<OffscreenContext> context_;
  std::unique_ptr<StagePainter> painter_;
};

const std::uint8_t* pixel(const Picture& picture, int x, int y) {
  return &picture.rgb[static_cast<std::size_t>(3 * (y * picture.width_px + x))];
}

int difference(const std::uint8_t* a, const std::uint8_t* b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

int differing(const Picture& a, const Picture& b, const PixelBox& box) {
  int count = 0;
  for (int y = box.top_px; y < box.top_px + box.height_px; ++y)
    for (int x = box.left_px; x < box.left_px + box.width_px; ++x)
      if (difference(pixel(a, x, y), pixel(b, x, y)) > 30) ++count;
  return count;
}

constexpr PixelBox kAll{0, 0, kViewWidth_px, kViewHeight_px};

TEST_F(ViewPicture, InTheMirrorIsTheSamePictureTurnedRound) {
  const SceneState scene = dressed(couple());
  ViewDirector director(CameraPreset::kAuto, ViewMode::kMirror);
  SceneState seen = scene;
  director.jump(seen, kPictureSize);
  OrbitCamera camera = director.camera();
  ASSERT_TRUE(camera.is_mirrored);
  const Picture mirrored = draw(scene, camera);
  camera.is_mirrored = false;
  const Picture plain = draw(scene, camera);
  int wrong = 0;
  for (int y = 0; y < kViewHeight_px; ++y)
    for (int x = 0; x < kViewWidth_px; ++x)
      if (difference(pixel(mirrored, x, y), pixel(plain, kViewWidth_px - 1 - x, y)) != 0) ++wrong;
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(differing(mirrored, plain, kAll), 1000) << "a couple is not the same on both sides";
}

TEST_F(ViewPicture, NamesInTheMirrorAreReadFromLeftToRight) {
  SceneState scene;
  scene.guests.push_back(guest_at_ease("alice", Eigen::Vector3f::Zero(), 0.0f));
  scene = dressed(scene);
  ViewDirector director(CameraPreset::kAuto, ViewMode::kMirror);
  director.jump(scene, kPictureSize);
  OverlayChoice tags = no_words();
  tags.tags = true;
  OrbitCamera camera = director.camera();
  // Straight from the front the tag is in the middle, mirrored or not.
  const Picture mirrored = draw(scene, camera, tags);
  camera.is_mirrored = false;
  const Picture plain = draw(scene, camera, tags);
  const auto at = project(camera, tag_anchor_W_m(scene.guests[0]), kViewWidth_px, kViewHeight_px);
  ASSERT_TRUE(at);
  const PixelBox tag{static_cast<int>(at->x_px) - 30, static_cast<int>(at->y_px) - 16, 60, 18};
  EXPECT_LT(differing(mirrored, plain, tag), 60) << "the letters are the same";
}

TEST_F(ViewPicture, ANameShowsHowItsGuestSpeaks) {
  SceneState scene;
  scene.guests.push_back(guest_at_ease("alice", Eigen::Vector3f::Zero(), 0.0f));
  scene = dressed(scene);
  ViewDirector director(CameraPreset::kAuto, ViewMode::kMirror);
  director.jump(scene, kPictureSize);
  OverlayChoice tags = no_words();
  tags.tags = true;
  const auto at =
      project(director.camera(), tag_anchor_W_m(scene.guests[0]), kViewWidth_px, kViewHeight_px);
  ASSERT_TRUE(at);
  const PixelBox tag{static_cast<int>(at->x_px) - 48, static_cast<int>(at->y_px) - 20, 96, 26};
  std::vector<Picture> pictures;
  for (const VoiceMark mark :
       {VoiceMark::kNone, VoiceMark::kDeafened, VoiceMark::kMuted, VoiceMark::kNoMicrophone,
        VoiceMark::kWaiting, VoiceMark::kTalking}) {
    scene.guests[0].voice_mark = mark;
    pictures.push_back(draw(scene, director.camera(), tags));
    EXPECT_EQ(differing(pictures.front(), pictures.back(), kAll),
              differing(pictures.front(), pictures.back(), tag))
        << "nothing but the tag changes";
  }
  for (std::size_t a = 0; a < pictures.size(); ++a)
    for (std::size_t b = a + 1; b < pictures.size(); ++b)
      EXPECT_GT(differing(pictures[a], pictures[b], tag), 10) << a << " and " << b;
}

TEST_F(ViewPicture, ThroughTheEyesOfADancerTheOwnHeadIsNotInTheWay) {
  SceneState scene = dressed(couple());
  // Without a captured gaze the partner's eyes would move when the first dancer is removed.
  scene.guests[1].face.emplace();
  scene.guests[1].face->presence = kFaceSeen | kGazeSeen;
  ViewDirector director(CameraPreset::kAuto, ViewMode::kFirstPerson);
  director.choose(scene.guests[0].id);
  director.jump(scene, kPictureSize);
  const Picture seen = draw(scene, director.camera());
  SceneState without = scene;
  without.guests.erase(without.guests.begin());
  const Picture empty = draw(without, director.camera());
  // In the middle of the picture nothing of the own body.
  const PixelBox middle{kViewWidth_px / 3, kViewHeight_px / 4, kViewWidth_px / 3,
                        kViewHeight_px / 4};
  const int in_the_way = differing(seen, empty, middle);
  SceneState with_head = scene;
  with_head.guests[0].hides_head = false;
  const Picture blocked = draw(with_head, director.camera());
  EXPECT_LT(in_the_way, differing(blocked, empty, middle) / 4 + 20);
  // From outside, the head is gone and the rest is there.
  const OrbitCamera outside;
  const Picture whole = draw(with_head, outside);
  const Picture headless = draw(scene, outside);
  EXPECT_GT(differing(whole, headless, kAll), 30);
}

TEST_F(ViewPicture, EachCellOfAGridHasItsOwnDancers) {
  SceneState scene;
  for (int i = 0; i < 4; ++i)
    scene.guests.push_back(guest_at_ease(("guest-" + std::to_string(i)).c_str(),
                                         {6.0f * static_cast<float>(i), 0, 0}, 0.0f));
  scene = dressed(scene);
  ViewDirector director(CameraPreset::kAuto, ViewMode::kGrid);
  director.choose(scene.guests[2].id);
  director.jump(scene, kPictureSize);
  OverlayChoice choice = no_words();
  choice.whole = &scene;
  ASSERT_TRUE(painter_->draw(director.cells(), kViewWidth_px, kViewHeight_px, choice));
  const Picture grid = painter_->read();
  std::vector<StageCell> empty(director.cells().begin(), director.cells().end());
  std::vector<SceneState> stages(empty.size());
  for (std::size_t i = 0; i < empty.size(); ++i) {
    stages[i].stage = empty[i].scene->stage;
    empty[i].scene = &stages[i];
  }
  ASSERT_TRUE(painter_->draw(empty, kViewWidth_px, kViewHeight_px, choice));
  const Picture bare = painter_->read();
  for (const StageCell& cell : director.cells()) {
    const int body = differing(grid, bare, cell.box);
    EXPECT_GT(body, cell.box.width_px * cell.box.height_px / 100) << cell.box.left_px;
  }
  // The chosen cell has a frame.
  const PixelBox& chosen = director.cells()[2].box;
  const std::uint8_t* corner = pixel(grid, chosen.left_px, chosen.top_px + chosen.height_px / 2);
  EXPECT_GT(corner[0], 150);
  const PixelBox& other = director.cells()[1].box;
  EXPECT_LT(pixel(grid, other.left_px, other.top_px + other.height_px / 2)[0], 150);
}

}  // namespace
}  // namespace dance
