// The panel of instruments, looked at pixel by pixel: bars as long as the stages, thirty rows.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/viewer/instruments/synthetic_line.h"
#include "tests/viewer/offscreen_test.h"
#include "viewer/instruments/instrument_panel.h"
#include "viewer/panel/panel_stack.h"
#include "viewer/stage/stage_painter.h"

namespace dance {
namespace {

using Rgb = std::array<int, 3>;
constexpr Rgb kToServer{0xf0, 0xb4, 0x3c}, kToHouse{0xd9, 0x65, 0x3b};

class PanelPictureTest : public OffscreenTest {
 protected:
  // Two seconds of dancers behind the line of synthetic_line.h.
  static Picture draw(int guests, int width_px, int height_px, float scale) {
    InstrumentBoard board(kHouseClock);
    for (std::uint32_t i = 0; i < 130; ++i) {
      const MonoTime captured = at_ms(5000.0 + i * (1000.0 / 60.0));
      const MonoTime now = captured + Duration::ms(60);
      for (int g = 0; g < guests; ++g) {
        // 24 letters, wide ones among them.
        const GuestId guest = guest_called("mmmmwwww-dancer-from-" + std::to_string(100 + g));
        const Pose pose = arrived_at_house(captured, i);
        board.on_pose(Where::kGuest, guest, pose, now);
        board.on_pose(Where::kStage, guest, pose, now);
        board.on_shown(guest, shown_at(pose, now, now + Duration::ms(8)));
      }
      board.end_seconds(now, [](const GuestId&, const GuestStats&) {});
    }
    InstrumentRecords records;
    records.take(board);
    EXPECT_EQ(records.guests().size(), static_cast<std::size_t>(guests));
    PanelStack panels;
    auto panel = std::make_unique<InstrumentPanel>(records);
    panel->open(true);
    panels.add(std::move(panel));
    auto painter = StagePainter::create(Quality::kLow, scale);
    EXPECT_TRUE(painter);
    OverlayChoice choice{false, false};
    choice.panels = &panels;
    const auto drawn = (*painter)->draw(SceneState(), OrbitCamera(), width_px, height_px, choice);
    EXPECT_TRUE(drawn) << drawn.error().what;
    const Picture picture = (*painter)->read();
    const std::string file = testing::TempDir() + "instruments-" + std::to_string(guests) + "-" +
                             std::to_string(height_px) + ".png";
    EXPECT_TRUE(write_png(file, picture));
    return picture;
  }

  static bool is_like(const Rgb& a, const Rgb& b) {
    for (std::size_t i = 0; i < 3; ++i)
      if (std::abs(a[i] - b[i]) > 6) return false;
    return true;
  }
  // The longest run of a colour in a row.
  static int run_of(const Picture& picture, int y, const Rgb& colour) {
    int longest = 0, run = 0;
    for (int x = 0; x < picture.width_px; ++x) {
      run = is_like(picture.at(x, y), colour) ? run + 1 : 0;
      longest = std::max(longest, run);
    }
    return longest;
  }
  // How many bars have that colour, longer than a legend's square.
  static int bars_of(const Picture& picture, const Rgb& colour, int least_px) {
    int bars = 0;
    bool was = false;
    for (int y = 0; y < picture.height_px; ++y) {
      const bool is = run_of(picture, y, colour) >= least_px;
      bars += is && !was ? 1 : 0;
      was = is;
    }
    return bars;
  }
};

TEST_F(PanelPictureTest, BarsAreAsLongAsTheirStages) {
  const Picture picture = draw(1, 1280, 720, 1.0f);
  int server = 0, house = 0;
  for (int y = 60; y < picture.height_px; ++y) {
    server = std::max(server, run_of(picture, y, kToServer));
    house = std::max(house, run_of(picture, y, kToHouse));
  }
  ASSERT_GT(server, 20);
  EXPECT_NEAR(static_cast<double>(house) / server, kReceived_ms / kServer_ms, 0.1);
}

TEST_F(PanelPictureTest, ThirtyGuestsHaveARowEach) {
  EXPECT_EQ(bars_of(draw(30, 1280, 720, 1.0f), kToServer, 20), 30);
}

TEST_F(PanelPictureTest, ThirtyGuestsHaveARowEachOnAFinerDisplay) {
  EXPECT_EQ(bars_of(draw(30, 2560, 1440, 2.0f), kToServer, 40), 30);
}

TEST_F(PanelPictureTest, ASmallWindowHasAsManyRowsAsFit) {
  const int bars = bars_of(draw(30, 800, 360, 1.0f), kToServer, 12);
  EXPECT_GT(bars, 5);
  EXPECT_LT(bars, 20);
}

}  // namespace
}  // namespace dance
