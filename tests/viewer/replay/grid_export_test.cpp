// An export that is drawn between the window's pictures, by the same painter, changes none of them.
#include <gtest/gtest.h>

#include "core/program/program.h"
#include "tests/viewer/driver_memory.h"
#include "viewer/avatar/user_avatars.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/gl/offscreen.h"
#include "viewer/program/export_painter.h"
#include "viewer/replay/index_builder.h"
#include "viewer/replay/replay_feed.h"

namespace dance {
namespace {

constexpr ViewPictureSize kSize{320, 180};

class GridExport : public ::testing::TestWithParam<ViewMode> {
 protected:
  GridExport() : view_(CameraPreset::kAuto, GetParam()) {
    auto index = build_index(log_, false, {});
    EXPECT_TRUE(index) << index.error().what;
    index_ = std::make_shared<const ReplayIndex>(std::move(*index));
    board_.emplace(index_->clock_id, false);
    roster_.emplace(*board_);
    auto feed = ReplayFeed::open(log_, index_, *board_);
    EXPECT_TRUE(feed) << feed.error().what;
    feed_.emplace(std::move(*feed));
  }

  SceneState scene_at(double s) {
    const MonoTime moment = index_->begin + Duration::seconds(s);
    feed_->show(moment);
    SceneState scene;
    roster_->update(moment, scene);
    avatars_.wait_and_dress(scene);
    return scene;
  }
  // As the window does it, with trails.
  Picture draw(double s, Duration passed) {
    scene_ = scene_at(s);
    scene_.shows_trails = true;
    view_.update(scene_, {kSize.width_px, kSize.height_px, 0}, passed);
    painter_->renderer().set_light_yaw(view_.light_yaw_rad());
    const OverlayChoice choice{false, false};
    const auto drawn = view_.comparison()
                           ? painter_->draw(*view_.comparison(), view_.camera(), kSize.width_px,
                                            kSize.height_px, choice)
                           : painter_->draw(view_.cells(), kSize.width_px, kSize.height_px, choice);
    EXPECT_TRUE(drawn);
    return painter_->read();
  }

  std::string log_ = std::string(DANCE_SOURCE_DIR) + "/logs/couple-packed.lcm";
  std::shared_ptr<const ReplayIndex> index_;
  std::optional<GuestBoard> board_;
  std::optional<StageRoster> roster_;
  std::optional<ReplayFeed> feed_;
  ViewDirector view_;
  SceneState scene_;
  std::unique_ptr<StagePainter> painter_;
  AvatarLibrary avatars_{avatars_of(AvatarStore::of_user(), data_folder() + "/avatars", {})};
};

TEST_P(GridExport, LeavesTheWindowsPicturesAsTheyWere) {
  const auto context = OffscreenContext::create();
  if (!context) GTEST_SKIP() << context.error().what;
  keep_drivers_loaded();
  auto painter = StagePainter::create(Quality::kLow, 1.0f);
  ASSERT_TRUE(painter) << painter.error().what;
  painter_ = std::move(*painter);
  double s = 2.0;
  for (int i = 0; i < 6; ++i, s += 0.05) draw(s, Duration::ms(50));
  draw(s, Duration());
  const Picture before = draw(s, Duration());

  ExportPainter exporting(view_, kSize, false, true);
  for (const double elsewhere : {7.0, 7.1, 7.2}) {
    SceneState scene = scene_at(elsewhere);
    const auto picture = exporting.paint(scene, Duration::ms(100), false, avatars_, *painter_);
    ASSERT_TRUE(picture) << picture.error().what;
    EXPECT_NE(picture->rgb, before.rgb);
  }
  EXPECT_EQ(draw(s, Duration()).rgb, before.rgb);
  painter_.reset();
}

INSTANTIATE_TEST_SUITE_P(Views, GridExport, ::testing::Values(ViewMode::kOrbit, ViewMode::kGrid),
                         [](const auto& of) {
                           return of.param == ViewMode::kGrid ? "Grid" : "Orbit";
                         });

}  // namespace
}  // namespace dance
