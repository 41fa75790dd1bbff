#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "viewer/avatar/user_avatars.h"
#include "viewer/feed/picture_source.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/gl/offscreen.h"
#include "viewer/program/view_program.h"
#include "viewer/replay/timeline/timeline_panel.h"
#include "viewer/stage/stage_painter.h"
#include "viewer/view/view_director.h"
#include "viewer/window/window_panels.h"

namespace dance {
namespace {

// Low priority: on a machine without a graphics card, drawing would take the processor from the
// programs that send and route.
constexpr int kDrawingNiceness = 10;

constexpr std::size_t kFewMoments = 16;
constexpr const char* kTitleOfRaw = "as it comes";
constexpr const char* kTitleOfRhythm = "in rhythm";
constexpr const char* kTitleOfShown = "as it is staged";

class HeadlessRun {
 public:
  HeadlessRun(const ViewOptions& options, std::vector<double> moments_s, PictureSource& source,
              StagePainter& painter)
      : options_(options),
        moments_s_(std::move(moments_s)),
        source_(source),
        painter_(painter),
        roster_(source.board()),
        director_(options.camera, options.view) {
    if (options.focus) director_.choose(*options.focus);
  }

  Result<void> run() {
    if (auto added = add_panels({options_, source_, records_, {}, wishes_, drawing_}, panels_);
        !added)
      return added;
    DANCE_TRY(const std::vector<MonoTime> moments, moments_to_draw());
    auto drawn = options_.moments.film ? film() : pictures(moments);
    if (drawn && options_.focus && !focus_was_here_)
      talk::warn("--focus {0}: nobody called {0} was on the stage of {1}", options_.focus->view(),
                 source_.name());
    return drawn;
  }

 private:
  Result<void> pictures(const std::vector<MonoTime>& moments) {
    for (std::size_t i = 0; i < moments.size(); ++i) {
      scenes_.push_back(scene_at(moments[i]));
      const bool is_last = i + 1 == moments.size();
      while (drawn_ < scenes_.size() && !is_last && draws_now(moments[i + 1]))
        if (auto written = write_picture(scenes_[drawn_++]); !written) return written;
      if (source_.is_over()) break;
    }
    if (is_strip()) {
      if (auto written = write_strip(); !written) return written;
    } else {
      while (drawn_ < scenes_.size())
        if (auto written = write_picture(scenes_[drawn_++]); !written) return written;
    }
    if (source_.board().poses() > 0) return {};
    return fail("no poses heard on " + source_.name() +
                "; bring dancers with: dance salsa, or dance replay FILE");
  }

  bool is_strip() const { return options_.moments.strip > 0; }
  // Many moments are drawn as they come, so that each file is there soon. A few are kept until
  // there is time, at the latest until the end: a picture takes seconds on a busy machine, and the
  // next moment would be missed.
  bool draws_now(MonoTime next) const {
    if (is_strip()) return false;
    const bool changes_meanwhile = !options_.panel.empty();
    if (moments_s_.size() > kFewMoments || changes_meanwhile) return true;
    return source_.replay() == nullptr && mono_now() + slowest_picture_ * 2 < next;
  }

  Result<std::vector<MonoTime>> moments_to_draw() const {
    std::vector<MonoTime> moments;
    for (const double moment_s : moments_s_)
      moments.push_back(source_.begin() + Duration::seconds(moment_s));
    if (options_.beats.empty()) return moments;
    moments.clear();
    for (const double beat : options_.beats) {
      const auto moment = source_.time_of_beat(beat);
      if (!moment)
        return fail("--beats: the music of " + source_.name() + " has no beat " +
                    std::to_string(std::lround(beat)));
      moments.push_back(*moment);
    }
    return moments;
  }

  ViewDirector::Size size_of(int width_px) const {
    const int height_px = options_.size.height_px;
    const SceneState none;
    const PanelFrame frame{none, static_cast<float>(width_px), static_cast<float>(height_px)};
    return {width_px, height_px, painter_.overlay().panel_height_px(height_px),
            static_cast<int>(panels_.bottom_px(frame))};
  }

  // Instruments show the last minute: a recording is gone through, not jumped into.
  void measure_up_to(MonoTime moment) {
    constexpr Duration kStep = Duration::ms(50);
    constexpr Duration kLookBack = Duration::s(60);
    MonoTime at = std::max(source_.begin(), moment - kLookBack);
    if (measured_.is_set()) at = std::max(at, measured_);
    for (SceneState scene; at < moment; at += kStep) {
      roster_.update(source_.wait_until(at), scene);
      records_.take(source_.instruments());
    }
    measured_ = moment;
  }

  SceneState scene_at(MonoTime moment) {
    SceneState scene;
    if (options_.panel == "instruments" && source_.replay() != nullptr) measure_up_to(moment);
    roster_.update(source_.wait_until(moment), scene);
    records_.take(source_.instruments());
    for (const SceneGuest& guest : scene.guests)
      focus_was_here_ = focus_was_here_ || guest.id == options_.focus;
    if (options_.view != ViewMode::kCompare) leave_out_twins(scene);
    avatars_.wait_and_dress(scene);
    if (scene.guests.empty()) scene.notes.push_back("nobody is on the stage of " + source_.name());
    return scene;
  }

  Result<void> draw(const SceneState& scene, int width_px, const OverlayChoice& choice) {
    painter_.renderer().set_light_yaw(director_.light_yaw_rad());
    return painter_.draw(scene, rig().camera(), width_px, options_.size.height_px, choice);
  }

  CameraRig& rig() { return director_.rig(); }

  // What the director has composed.
  Result<Picture> paint(const SceneState& scene, const OverlayChoice& wished, int width_px) {
    OverlayChoice choice = wished;
    choice.panels = &panels_;
    choice.whole = &scene;
    if (options_.view == ViewMode::kCompare && !director_.comparison() && !has_warned_) {
      has_warned_ = true;
      talk::warn("--view compare: {}", director_.words());
    }
    painter_.renderer().set_light_yaw(director_.light_yaw_rad());
    const int height_px = options_.size.height_px;
    auto drawn = director_.comparison()
                     ? painter_.draw(*director_.comparison(), director_.camera(), width_px,
                                     height_px, choice)
                     : painter_.draw(director_.cells(), width_px, height_px, choice);
    if (!drawn) return tl::make_unexpected(drawn.error());
    return painter_.read();
  }

  Result<void> write_picture(SceneState& scene) {
    const MonoTime begin = mono_now();
    director_.jump(scene, size_of(options_.size.width_px));
    DANCE_TRY(const Picture picture,
              paint(scene, {options_.tags, options_.hud}, options_.size.width_px));
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "stage-%04d.png", ++pictures_);
    auto written = write(name.data(), picture);
    slowest_picture_ = std::max(slowest_picture_, mono_now() - begin);
    return written;
  }

  // Every picture of it, however long they take. The camera follows as in a window.
  Result<void> film() {
    const Duration period = Duration::period_of_hz(kFilm_hz);
    const double most_s = moments_s_.back();
    for (int k = 0; static_cast<double>(k) / kFilm_hz < most_s; ++k) {
      SceneState scene = scene_at(source_.begin() + period * k);
      if (source_.is_over()) break;
      const ViewDirector::Size size = size_of(options_.size.width_px);
      if (k == 0)
        director_.jump(scene, size);
      else
        director_.update(scene, size, period);
      DANCE_TRY(const Picture picture, paint(scene, {options_.tags, options_.hud}, size.width_px));
      std::array<char, 32> name{};
      std::snprintf(name.data(), name.size(), "%04d.png", ++pictures_);
      if (auto written = write(name.data(), picture); !written) return written;
    }
    if (pictures_ > 0) return {};
    return fail(source_.name() + " ends before the first picture");
  }

  // The moments share one camera, so that what changes between them is the dance.
  Result<void> write_strip() {
    const int width_px = std::max(1, options_.size.width_px / static_cast<int>(scenes_.size()));
    if (is_of_one(options_.view) || options_.view == ViewMode::kGrid) {
      DANCE_TRY(const Picture row, paint_views(width_px));
      return write("stage-strip.png", row);
    }
    std::vector<const SceneState*> all;
    for (const SceneState& scene : scenes_) all.push_back(&scene);
    rig().jump(all, static_cast<float>(width_px) / static_cast<float>(options_.size.height_px));
    const bool compares = options_.view == ViewMode::kCompare && can_compare(scenes_.front());
    if (!compares) {
      DANCE_TRY(const Picture row, paint_row(scenes_, width_px, ""));
      return write("stage-strip.png", row);
    }
    std::vector<SceneState> raw, shown;
    for (const SceneState& scene : scenes_) {
      Comparison both = compare(scene);
      raw.push_back(std::move(both.raw));
      shown.push_back(std::move(both.shown));
    }
    DANCE_TRY(const Picture above, paint_row(raw, width_px, kTitleOfRaw));
    const bool has_rhythm = has_twins(scenes_.front());
    DANCE_TRY(const Picture below,
              paint_row(shown, width_px, has_rhythm ? kTitleOfRhythm : kTitleOfShown));
    return write("stage-strip.png", one_above_the_other(std::array{above, below}));
  }

  // Each moment by its own camera, which goes with the dancer.
  Result<Picture> paint_views(int width_px) {
    std::vector<Picture> moments;
    for (SceneState& scene : scenes_) {
      director_.jump(scene, size_of(width_px));
      const OverlayChoice choice{options_.tags, false, "",
                                 options_.beats.empty() ? "" : caption_of(scene)};
      DANCE_TRY(Picture picture, paint(scene, choice, width_px));
      moments.push_back(std::move(picture));
    }
    return side_by_side(moments);
  }

  Result<Picture> paint_row(const std::vector<SceneState>& scenes, int width_px,
                            const std::string& title) {
    std::vector<Picture> moments;
    for (const SceneState& scene : scenes) {
      const bool is_first = &scene == &scenes.front();
      const OverlayChoice choice{options_.tags, false, is_first ? title : "",
                                 options_.beats.empty() ? "" : caption_of(scene)};
      if (auto drawn = draw(scene, width_px, choice); !drawn)
        return tl::make_unexpected(drawn.error());
      moments.push_back(painter_.read());
    }
    return side_by_side(moments);
  }

  // What a dancer counts there.
  static std::string caption_of(const SceneState& scene) {
    if (!scene.music) return "";
    const int beat = static_cast<int>(std::lround(scene.music->beats));
    if (scene.music->beats_per_bar != 4) return "beat " + std::to_string(beat);
    return "count " + std::to_string(((beat % 8) + 8) % 8 + 1);
  }

  Result<void> write(const std::string& name, const Picture& picture) {
    const std::string file = (std::filesystem::path(options_.out) / name).string();
    if (auto written = write_png(file, picture); !written) return written;
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    return {};
  }

  const ViewOptions& options_;
  const std::vector<double> moments_s_;
  PictureSource& source_;
  StagePainter& painter_;
  StageRoster roster_;
  AvatarLibrary avatars_{
      avatars_of(AvatarStore::of_user(), data_folder() + "/avatars", options_.avatars)};
  InstrumentRecords records_;
  MonoTime measured_;             // by them, of a recording
  DanceWishes wishes_;            // nobody asks for anything
  BannerWatch::Drawing drawing_;  // in no hurry
  PanelStack panels_;
  ViewDirector director_;
  std::vector<SceneState> scenes_;
  std::size_t drawn_ = 0;                      // of these
  Duration slowest_picture_ = Duration::s(1);  // as long, until one has taken longer
  int pictures_ = 0;
  bool focus_was_here_ = false;
  bool has_warned_ = false;
};

}  // namespace

Result<void> run_headless(const ViewOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error)
    return fail("--out " + options.out + " cannot be made: " + error.message() +
                "; choose another directory");
  DANCE_TRY(auto source, PictureSource::open(options));
  DANCE_TRY(const std::vector<double> moments_s,
            plan_moments(options.moments, source->recorded().as_seconds()));
  // This thread alone, and those that the driver starts from it.
  setpriority(PRIO_PROCESS, 0, kDrawingNiceness);
  DANCE_TRY(auto context, OffscreenContext::create());
  const Quality quality = options.quality == QualityWish::kLow ? Quality::kLow : Quality::kHigh;
  DANCE_TRY(auto painter, StagePainter::create(quality, 1.0f));
  painter->set_place(place_to_draw(options));
  painter->overlay().set_language(options.language);
  if (!painter->overlay().font_note().empty()) talk::info("{}", painter->overlay().font_note());
  return HeadlessRun(options, moments_s, *source, *painter).run();
}

}  // namespace dance
