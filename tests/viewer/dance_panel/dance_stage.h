// The dance panel over a couple, with a bus that the test plays: for pictures and for what a person
// does with mouse and keys. DANCE_PICTURES names a folder where the pictures are to be kept.
//
// Units/frames: times of the house's clock.
// Ownership:    owns everything.
// Threads:      one.
// Failure:      skips where nothing can be drawn.
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "tests/test_folder.h"
#include "tests/viewer/dressed_scene.h"
#include "tests/viewer/instruments/synthetic_line.h"
#include "tests/viewer/offscreen_test.h"
#include "tests/viewer/test_scene.h"
#include "viewer/dance_panel/dance_panel.h"
#include "viewer/panel/panel_stack.h"
#include "viewer/stage/stage_painter.h"

namespace dance {

constexpr double kBegin_ms = 900'000.0;
constexpr int kWidth_px = 1280, kHeight_px = 720;

// How the line of a guest is.
struct Line {
  std::string name;
  bool is_remote = true;
  int lost_of_ten = 0;
  double late_ms = 40.0;
  bool is_silent = false;
};

class DanceStage : public OffscreenTest {
 protected:
  void begin(Language language, int width_px, int height_px, float scale) {
    width_px_ = width_px;
    height_px_ = height_px;
    DanceNeeds needs{board_,   figures_, wishes_,
                     drawing_, language, {folder_.path("dance-record"), folder_.path("videos"), ""},
                     {},       {},       {}};
    needs.music.plays_here = [this] { return plays_music_; };
    needs.music.tell = [this](double volume) -> Result<void> {
      music_told_.push_back(volume);
      return {};
    };
    needs.music.keep = [this](double volume) -> Result<void> {
      music_kept_.push_back(volume);
      return {};
    };
    needs.music.volume = 0.6;
    needs.wall = [this] { return now_ - MonoTime(); };
    needs.music.control_band = [this](BandRequest request, int style) -> Result<void> {
      band_asked_.emplace_back(request, style);
      return {};
    };
    needs.music.send_speed = [this](double speed) -> Result<void> {
      speeds_told_.push_back(speed);
      return {};
    };
    needs.has_role = [](const GuestId& guest) { return guest.view() == "alice"; };
    needs.send_role = [this](const GuestId& guest, std::string_view role) -> Result<void> {
      roles_sent_.push_back(std::string(guest.view()) + ": " + std::string(role));
      return {};
    };
    needs.send_voice_command = [this](const GuestId& guest,
                                      std::string_view command) -> Result<void> {
      told_.push_back(std::string(guest.view()) + ": " + std::string(command));
      return {};
    };
    needs.own = own_needs_;
    auto panel = std::make_unique<DancePanel>(std::move(needs));
    panel_ = panel.get();
    panels_.add(std::move(panel));
    auto painter = StagePainter::create(Quality::kLow, scale);
    ASSERT_TRUE(painter) << painter.error().what;
    painter_ = std::move(*painter);
    ImGui::GetIO().MousePos = {-1e6f, -1e6f};
    scene_ = dressed(couple());
    scene_.guests[1].voice = 0.7f;
    scene_.music = SceneMusic{33.2, 98.0 / 60.0, 4};
    scene_.voices.push_back({guest_called("alice"), false, false, true, false, true});
    Music music;
    EXPECT_TRUE(music.title.assign("Quimbara - Celia Cruz & Johnny Pacheco (live, long version)"));
    board_.on_music(music);
    HouseLink link;
    link.state = HouseLinkState::kConnected;
    link.may_remove = true;
    if (is_in_room_) link_ = link;
    tell_of({{"alice", false}, {"bob"}});
  }

  // Some seconds of these guests, as bus and instruments hear them.
  void tell_of(const std::vector<Line>& lines) {
    lines_ = lines;
    for (int second = 0; second < 8; ++second) {
      const auto sequence = static_cast<std::uint32_t>(now_.since_zero_us() / 1'000'000 * 60);
      for (const Line& line : lines) {
        const GuestId id = guest_called(line.name);
        for (std::uint32_t i = 0; i < 60 && !(line.is_silent && second > 2); ++i) {
          if (static_cast<int>(i % 10) < line.lost_of_ten) continue;
          const MonoTime captured = now_ + Duration::ms(16) * static_cast<int>(i);
          const MonoTime heard = captured + Duration::seconds(1e-3 * line.late_ms);
          Pose pose = dance_at(captured, sequence + i);
          pose.stamp(Hop::kLinkReceived, heard);
          instruments_.on_pose(line.is_remote ? Where::kGuest : Where::kCapture, id, pose, heard);
          instruments_.on_shown(id, shown_at(pose, heard, heard + Duration::ms(8)));
        }
        tell_status(line, line.is_silent && second > 2);
      }
      now_ += Duration::s(1);
      instruments_.end_seconds(now_, [](const GuestId&, const GuestStats&) {});
      figures_.take(instruments_);
      if (panel_ != nullptr) work();
    }
  }

  void tell_status(const Line& line, bool is_silent) {
    const GuestId id = guest_called(line.name);
    GuestStatus status;
    status.remote = line.is_remote;
    status.alive = true;
    status.received = is_silent ? 180 : now_.since_zero_us() / 10'000;
    board_.on_status(id, status, now_);
    if (line.is_remote) board_.on_traffic(id, now_);
  }

  void work() {
    if (link_) board_.on_link(*link_, now_);
    panel_->records().take(board_, now_);
    panel_->records().judge(figures_, scene_, now_);
  }

  void pass_time() {
    now_ += Duration::ms(16);
    scene_.time = now_;
    if (link_) board_.on_link(*link_, now_);
    board_.on_level(guest_called("alice"), {now_, 1, -22, -24}, now_);
    if (now_ - told_at_ < Duration::s(1)) return;
    told_at_ = now_;
    for (const Line& line : lines_) tell_status(line, line.is_silent);
  }
  // The panels of a picture, without the dancers: so that many of them cost little.
  void turn() {
    pass_time();
    OverlayChoice choice{false, false};
    choice.panels = &panels_;
    choice.whole = &scene_;
    painter_->overlay().draw_frames({}, width_px_, height_px_, choice);
  }
  Picture draw() {
    pass_time();
    OverlayChoice choice{true, false};
    choice.panels = &panels_;
    std::vector<Eigen::Vector3f> points;
    for (const SceneGuest& guest : scene_.guests) append_outline(guest, points);
    const OrbitCamera camera =
        frame_points(OrbitCamera(), points,
                     static_cast<float>(width_px_) / static_cast<float>(height_px_), 0.86f);
    const auto drawn = painter_->draw(scene_, camera, width_px_, height_px_, choice);
    EXPECT_TRUE(drawn) << drawn.error().what;
    return painter_->read();
  }
  Picture keep(const std::string& name) {
    const Picture picture = draw();
    const char* folder = std::getenv("DANCE_PICTURES");
    if (folder != nullptr) {
      EXPECT_TRUE(write_png(std::string(folder) + "/" + name + ".png", picture));
    }
    return picture;
  }

  bool press(int key, bool has_shift = false) {
    KeyPress pressed;
    pressed.key = key;
    pressed.has_shift = has_shift;
    const bool is_taken = panels_.on_key(pressed);
    turn();
    return is_taken;
  }
  void move(float x, float y) {
    ImGui::GetIO().MousePos = {x, y};
    turn();
  }
  void click(float x, float y) {
    move(x, y);
    ImGui::GetIO().MouseDown[0] = true;
    turn();
    ImGui::GetIO().MouseDown[0] = false;
    turn();
  }
  // Down with the keyboard until something is so, as a person looks for a control.
  template <class Done>
  bool find_with_keys(Done done, int most = 200) {
    for (int i = 0; i < most; ++i) {
      press(GLFW_KEY_DOWN);
      press(GLFW_KEY_ENTER);
      if (done()) return true;
    }
    return false;
  }
  // A click on each place of a grid within the column, until something is so.
  template <class Done>
  bool find_with_mouse(Done done) {
    const float left = static_cast<float>(width_px_) - 305.0f;
    for (float y = 20.0f; y < static_cast<float>(height_px_) - 12.0f; y += 11.0f)
      for (float x = left; x < static_cast<float>(width_px_) - 15.0f; x += 34.0f) {
        if (!panel_->is_open()) panel_->open(true);
        click(x, y);
        if (done()) return true;
      }
    return false;
  }

  // Pixels that differ between two pictures, in a part of them.
  static int changed(const Picture& a, const Picture& b, int x_from, int x_to) {
    int count = 0;
    for (int y = 0; y < a.height_px; ++y)
      for (int x = x_from; x < x_to; ++x) count += a.at(x, y) != b.at(x, y) ? 1 : 0;
    return count;
  }

  TestFolder folder_{"dance-picture"};
  DanceBoard board_;
  InstrumentBoard instruments_{kHouseClock};
  InstrumentRecords figures_;
  DanceWishes wishes_;
  OwnNeeds own_needs_;  // set before begin()
  BannerWatch::Drawing drawing_;
  PanelStack panels_;
  DancePanel* panel_ = nullptr;
  std::unique_ptr<StagePainter> painter_;
  SceneState scene_;
  bool is_in_room_ = true;  // to be set before begin()
  std::optional<HouseLink> link_;
  std::vector<std::string> told_;
  bool plays_music_ = true;
  std::vector<double> music_told_, music_kept_, speeds_told_;
  std::vector<std::pair<BandRequest, int>> band_asked_;
  std::vector<std::string> roles_sent_;
  std::vector<Line> lines_;
  MonoTime now_ = at_ms(kBegin_ms), told_at_;
  int width_px_ = kWidth_px, height_px_ = kHeight_px;
};

}  // namespace dance
