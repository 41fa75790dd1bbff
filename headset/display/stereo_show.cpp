#include <chrono>
#include <thread>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "headset/display/headset_display.h"
#include "headset/program/headset_run.h"
#include "headset/program/loss_words.h"
#include "headset/stereo/xr_graphics.h"
#include "viewer/avatar/user_avatars.h"
#include "viewer/gl/offscreen.h"
#include "voice/control/voice_control.h"

namespace dance {
namespace {

class StereoShow final : public HeadsetShow {
 public:
  static Result<std::unique_ptr<HeadsetShow>> create(const HeadsetOptions& options) {
    std::unique_ptr<StereoShow> show(new StereoShow(options));
    if (auto opened = show->open(); !opened) return tl::make_unexpected(opened.error());
    return std::unique_ptr<HeadsetShow>(std::move(show));
  }

  XrUse use() const override { return XrUse::kDisplay; }

  Result<const void*> binding(const XrRuntime& runtime) override {
    DANCE_TRY(graphics_, XrGraphics::of_current(runtime));
    return graphics_->binding();
  }

  Result<void> begin(XrDancerSession& session, XrInput& input, HeadsetCapture& capture) override {
    losses_ = {};
    HeadsetDisplayOptions display;
    display.own = options_.capture.guest;
    display.comfort = {options_.personal_space_m, options_.floor_m};
    display.scale = options_.scale;
    display.tags = options_.tags;
    display.place = parse_place(options_.place).value_or(Venue::kPlain);
    DANCE_TRY(display_,
              HeadsetDisplay::create(session, input, capture, *scene_, *window_, *painter_, display,
                                     [this](bool mutes) { tell(mutes); }));
    return {};
  }

  Result<void> turn() override {
    const auto turned = display_->turn();
    losses_.tell(display_->told().lost);
    return turned;
  }

  void end() override {
    if (!display_) return;
    has_left_ = display_->has_left();
    summary_ = display_->summary();
    display_.reset();
  }

  void wait(Duration longest) override {
    window_->poll_events();
    std::this_thread::sleep_for(std::chrono::nanoseconds(longest.count_ns()));
  }
  bool is_over() const override { return source_->is_over() || window_->is_over(); }
  bool was_asked_to_end() const override { return source_->is_over(); }
  bool has_left() const override { return display_ ? display_->has_left() : has_left_; }
  std::string summary() const override { return summary_; }

 private:
  explicit StereoShow(const HeadsetOptions& options) : options_(options) {}

  Result<void> open() {
    ViewOptions view;
    view.feed.bus_url = options_.capture.bus_url;
    // Before other threads, as it takes the signals.
    DANCE_TRY(source_, PictureSource::open(view));
    DANCE_TRY(window_, HeadsetWindow::create(options_.is_mirrored));
    using Wish = HeadsetOptions::Quality;
    const bool is_software = is_software_rendering();
    const bool is_plain =
        options_.quality == Wish::kLow || (options_.quality == Wish::kAuto && is_software);
    if (is_software) talk::info("no graphics card here: pictures hardly come in time");
    const Language language = parse_language(options_.language).value_or(language_of_user());
    DANCE_TRY(painter_, StereoPainter::create(is_plain ? Quality::kLow : Quality::kHigh, language));
    const std::string shipped = data_folder() + "/avatars";
    std::vector<AvatarOverride> avatars;
    for (const std::string& text : options_.avatars) {
      DANCE_TRY(AvatarOverride avatar, parse_avatar_override(text, shipped));
      avatars.push_back(std::move(avatar));
    }
    scene_ = std::make_unique<HeadsetScene>(*source_, options_.capture.guest, options_.capture.body,
                                            avatars_of(AvatarStore::of_user(), shipped, avatars));
    return {};
  }

  void tell(bool mutes) {
    const auto told = send_voice_command(options_.capture.bus_url, options_.capture.guest,
                                         mutes ? "mute" : "unmute");
    if (!told) talk::warn("{}", told.error().what);
  }

  HeadsetOptions options_;
  std::unique_ptr<PictureSource> source_;
  std::unique_ptr<HeadsetWindow> window_;
  std::unique_ptr<StereoPainter> painter_;
  std::unique_ptr<HeadsetScene> scene_;
  std::unique_ptr<XrGraphics> graphics_;
  std::unique_ptr<HeadsetDisplay> display_;
  LossWords losses_;
  std::string summary_;
  bool has_left_ = false;
};

}  // namespace

Result<std::unique_ptr<HeadsetShow>> make_stereo_show(const HeadsetOptions& options) {
  return StereoShow::create(options);
}

}  // namespace dance
