#include <sys/resource.h>

#include <cstdio>
#include <filesystem>
#include <thread>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "viewer/offscreen.h"
#include "viewer/stage_painter.h"
#include "viewer/stage_roster.h"
#include "viewer/view_program.h"

namespace dance {
namespace {

// A picture may take its time, the dance may not: on a machine without a graphics card, drawing
// would take the processor from those who send and route.
constexpr int kDrawingNiceness = 10;

constexpr std::size_t kFewMoments = 16;

class HeadlessRun {
 public:
  HeadlessRun(const ViewOptions& options, StageFeed& feed, StagePainter& painter)
      : options_(options),
        feed_(feed),
        painter_(painter),
        roster_(feed.board()),
        rig_(options.camera) {
    if (options.focus) rig_.focus(*options.focus);
  }

  Result<void> run() {
    const MonoTime start = mono_now();
    for (const double moment_s : options_.moments_s) {
      wait_until(start + Duration::seconds(moment_s));
      SceneState scene;
      roster_.update(mono_now(), scene);
      if (scene.guests.empty()) scene.notes.push_back("nobody is on the stage of " + feed_.url());
      scenes_.push_back(std::move(scene));
      if (draws_at_once())
        if (auto written = write_picture(scenes_.back()); !written) return written;
      if (feed_.is_over()) break;
    }
    if (options_.strip) {
      if (auto written = write_strip(); !written) return written;
    } else if (!draws_at_once()) {
      for (const SceneState& scene : scenes_)
        if (auto written = write_picture(scene); !written) return written;
    }
    if (feed_.board().poses() > 0) return {};
    return fail("no poses heard on " + feed_.url() +
                "; bring dancers with: dance salsa, or dance replay FILE");
  }

 private:
  // A few moments are kept and drawn at the end: a picture takes seconds on a busy machine, and the next moment would be
  // missed. Many are drawn as they come, for whoever waits for them.
  bool draws_at_once() const { return !options_.strip && options_.moments_s.size() > kFewMoments; }

  void wait_until(MonoTime moment) const {
    constexpr Duration kLook = Duration::ms(20);
    for (MonoTime now = mono_now(); now < moment && !feed_.is_over(); now = mono_now())
      std::this_thread::sleep_for(
          std::chrono::nanoseconds(std::min(moment - now, kLook).count_ns()));
  }

  Result<void> draw(const SceneState& scene, int width_px, const OverlayChoice& choice) {
    painter_.renderer().set_light_yaw(rig_.stage_yaw_rad());
    return painter_.draw(scene, rig_.camera(), width_px, options_.size.height_px, choice);
  }

  Result<void> write_picture(const SceneState& scene) {
    const PictureSize& size = options_.size;
    rig_.jump({&scene}, static_cast<float>(size.width_px) / static_cast<float>(size.height_px));
    if (auto drawn = draw(scene, size.width_px, {options_.tags, options_.hud}); !drawn)
      return drawn;
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "stage-%04d.png", ++pictures_);
    return write(name.data(), painter_.read());
  }

  // The moments share one camera, so that what changes between them is the dance.
  Result<void> write_strip() {
    const int width_px = std::max(1, options_.size.width_px / static_cast<int>(scenes_.size()));
    std::vector<const SceneState*> all;
    for (const SceneState& scene : scenes_) all.push_back(&scene);
    rig_.jump(all, static_cast<float>(width_px) / static_cast<float>(options_.size.height_px));
    std::vector<Picture> moments;
    for (const SceneState& scene : scenes_) {
      if (auto drawn = draw(scene, width_px, {options_.tags, false}); !drawn) return drawn;
      moments.push_back(painter_.read());
    }
    return write("stage-strip.png", side_by_side(moments));
  }

  Result<void> write(const std::string& name, const Picture& picture) {
    const std::string file = (std::filesystem::path(options_.out) / name).string();
    if (auto written = write_png(file, picture); !written) return written;
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    return {};
  }

  const ViewOptions& options_;
  StageFeed& feed_;
  StagePainter& painter_;
  StageRoster roster_;
  CameraRig rig_;
  std::vector<SceneState> scenes_;
  int pictures_ = 0;
};

}  // namespace

Result<void> run_headless(const ViewOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error)
    return fail("--out " + options.out + " cannot be made: " + error.message() +
                "; choose another directory");
  DANCE_TRY(auto feed, StageFeed::create(options.feed));
  // This thread alone, and those that the driver starts from it.
  setpriority(PRIO_PROCESS, 0, kDrawingNiceness);
  DANCE_TRY(auto context, OffscreenContext::create());
  const Quality quality = options.quality == QualityWish::kLow ? Quality::kLow : Quality::kHigh;
  DANCE_TRY(auto painter, StagePainter::create(quality, 1.0f));
  if (!painter->overlay().font_note().empty()) talk::info("{}", painter->overlay().font_note());
  return HeadlessRun(options, *feed, *painter).run();
}

}  // namespace dance
