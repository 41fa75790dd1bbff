#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "viewer/avatar/avatar_library.h"
#include "viewer/feed/picture_source.h"
#include "viewer/gl/offscreen.h"
#include "viewer/instruments/instrument_panel.h"
#include "viewer/program/view_program.h"
#include "viewer/stage/stage_painter.h"
#include "viewer/window/view_window.h"

namespace dance {
namespace {

// How often pictures come, averaged over about a second.
class PictureRate {
 public:
  void on_picture(MonoTime now) {
    if (last_.is_set()) {
      const double period_s = (now - last_).as_seconds();
      mean_period_s_ += std::min(1.0, period_s) * (period_s - mean_period_s_);
    }
    last_ = now;
  }
  double hz() const { return 1.0 / mean_period_s_; }

 private:
  MonoTime last_;
  double mean_period_s_ = 1.0 / 60.0;
};

Quality quality_of(QualityWish wish) {
  if (wish == QualityWish::kAuto) return is_software_rendering() ? Quality::kLow : Quality::kHigh;
  return wish == QualityWish::kLow ? Quality::kLow : Quality::kHigh;
}

class WindowRun {
 public:
  WindowRun(const ViewOptions& options, CameraRig& rig, PictureSource& source, ViewWindow& window,
            StagePainter& painter)
      : options_(options),
        rig_(rig),
        source_(source),
        window_(window),
        painter_(painter),
        begun_(mono_now()),
        roster_(source.board()) {
    window_.set_panels(&panels_);
    panels_.add(std::make_unique<InstrumentPanel>(records_));
  }

  Result<void> run() {
    MonoTime last = house_time(begun_);
    while (!window_.is_over() && !source_.is_over()) {
      window_.poll_events();
      const ViewWindow::Size size = window_.framebuffer_size();
      if (size.width_px <= 0 || size.height_px <= 0) {  // minimised: nothing to draw
        window_.wait_for_events(Duration::ms(100));
        continue;
      }
      const MonoTime now = mono_now();
      const MonoTime house_now = house_time(now);
      if (auto drawn = draw(house_now, house_now - last, size); !drawn) return drawn;
      last = house_now;
      pace(now);
    }
    return {};
  }

 private:
  // A recorded house's clock goes along with ours.
  MonoTime house_time(MonoTime now) { return source_.wait_until(source_.begin() + (now - begun_)); }

  Result<void> draw(MonoTime now, Duration since_last, ViewWindow::Size size) {
    roster_.update(now, scene_);
    records_.take(source_.instruments());
    has_twins_ = has_twins(scene_);
    const bool is_split = has_twins_ && window_.compares();
    if (!is_split) leave_out_twins(scene_);
    if (const auto key = window_.take_focus_key(); key && *key < scene_.guests.size())
      rig_.focus(scene_.guests[*key].id);
    const float aspect =
        is_split ? painter_.aspect_of_half(size.width_px, size.height_px)
                 : static_cast<float>(size.width_px) / static_cast<float>(size.height_px);
    rig_.update(scene_, aspect, since_last);
    painter_.renderer().set_light_yaw(rig_.stage_yaw_rad());
    painter_.overlay().set_scale(window_.scale());
    write_notes();
    avatars_.dress(scene_);
    window_.pass_input_to_panels();
    OverlayChoice choice{options_.tags, options_.hud && window_.shows_hud()};
    choice.panels = &panels_;
    auto drawn =
        is_split
            ? painter_.draw(compare(scene_), rig_.camera(), size.width_px, size.height_px, choice)
            : painter_.draw(scene_, rig_.camera(), size.width_px, size.height_px, choice);
    if (!drawn) return drawn;
    painter_.present();
    window_.swap();
    const MonoTime swap_time = mono_now();
    rate_.on_picture(swap_time);
    source_.report_shown(roster_.fresh(), swap_time);
    return {};
  }

  void write_notes() {
    scene_.notes.clear();
    if (scene_.guests.empty()) {
      scene_.notes.push_back("nobody is on the stage of " + source_.name() +
                             " yet; bring dancers with: dance salsa, or dance replay FILE");
    }
    if (options_.focus && !focus_was_here_) {
      focus_was_here_ =
          std::any_of(scene_.guests.begin(), scene_.guests.end(),
                      [&](const SceneGuest& guest) { return guest.id == *options_.focus; });
      if (!focus_was_here_ && !scene_.guests.empty())
        scene_.notes.push_back("--focus " + std::string(options_.focus->view()) +
                               ": not here yet; until then everybody is shown");
    }
    if (!options_.hud || !window_.shows_hud()) return;
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(),
                  "%.0f pictures/s   F all   1-9 one   space turn   H figures   %sQ quit",
                  rate_.hz(), has_twins_ ? "C compare   " : "");
    scene_.notes.push_back(text.data());
  }

  // Where the driver does not wait for the display, we do: more pictures than it shows only burn
  // power.
  void pace(MonoTime begun) {
    const Duration period = Duration::period_of_hz(window_.refresh_hz());
    const Duration left = period - (mono_now() - begun);
    if (left > Duration::ms(1)) window_.wait_for_events(left - Duration::us(500));
  }

  const ViewOptions& options_;
  CameraRig& rig_;
  PictureSource& source_;
  ViewWindow& window_;
  StagePainter& painter_;
  MonoTime begun_;
  StageRoster roster_;
  AvatarLibrary avatars_;
  SceneState scene_;
  InstrumentRecords records_;
  PanelStack panels_;
  PictureRate rate_;
  bool has_twins_ = false;
  bool focus_was_here_ = false;
};

}  // namespace

Result<void> run_window(const ViewOptions& options) {
  CameraRig rig(options.camera);
  if (options.focus) rig.focus(*options.focus);
  rig.set_turning(options.camera == CameraPreset::kAuto || options.camera == CameraPreset::kOrbit);
  DANCE_TRY(auto source, PictureSource::open(options));
  DANCE_TRY(auto window, ViewWindow::create({options.size.width_px, options.size.height_px}, rig));
  DANCE_TRY(auto painter, StagePainter::create(quality_of(options.quality), window->scale()));
  if (!painter->overlay().font_note().empty()) talk::info("{}", painter->overlay().font_note());
  if (options.quality == QualityWish::kAuto && painter->renderer().quality() == Quality::kLow)
    talk::info("no graphics card here: drawing plainly; --quality high draws all the same");
  window->set_comparing(options.compare);
  auto ended = WindowRun(options, rig, *source, *window, *painter).run();
  if (source->board().no_room() > 0)
    talk::warn("{} messages of guests beyond the {} that fit were left out",
               source->board().no_room(), GuestBoard::kMaxGuests);
  return ended;
}

}  // namespace dance
