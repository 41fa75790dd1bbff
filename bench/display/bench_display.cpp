#include "bench/display/bench_display.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "core/net/mono_clock.h"
#include "producers/salsa/salsa_dancer.h"
#include "viewer/avatar/avatar_library.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/gl/offscreen.h"
#include "viewer/stage/stage_painter.h"
#include "viewer/view/view_director.h"
#include "viewer/window/view_window.h"

namespace dance {
namespace {

// Each way for so long, then the other: what else the machine does falls on both.
constexpr Duration kBlock = Duration::s(2);
// After a change of ways the first pictures are not counted.
constexpr Duration kSettling = Duration::ms(400);
constexpr Duration kLearning = Duration::ms(2500);
constexpr Duration kWaits = Duration::us(400);

void sleep_until(MonoTime moment) {
  for (MonoTime now = mono_now(); now < moment; now = mono_now())
    std::this_thread::sleep_for(std::chrono::nanoseconds((moment - now).count_ns()));
}

// Captures of salsa dancers, whose clock stands in no relation to the display's.
class Captures {
 public:
  Captures(const BenchDisplayOptions& options, GuestBoard& board)
      : thread_([this, &options, &board] { run(options, board); }) {}
  ~Captures() {
    is_over_.store(true);
    thread_.join();
  }

 private:
  void run(const BenchDisplayOptions& options, GuestBoard& board) {
    std::vector<SalsaDancer> dancers;
    std::vector<GuestId> ids;
    for (int i = 0; i < options.guests; ++i) {
      SalsaStyle style;
      style.role = i % 2 == 0 ? SalsaRole::kLead : SalsaRole::kFollow;
      dancers.emplace_back(style);
      ids.push_back(*GuestId::parse("guest-" + std::to_string(i)));
    }
    // A little off the nominal rate, so that all phases to the display come by.
    const Duration period = Duration::period_of_hz(options.pose_hz * 1.0037);
    const MonoTime begin = mono_now();
    Pose pose;
    for (std::uint32_t k = 0; !is_over_.load(); ++k) {
      const MonoTime due = begin + period * k;
      sleep_until(due);
      for (std::size_t i = 0; i < dancers.size(); ++i) {
        dancers[i].dance_at(due - begin, pose);
        pose.p_WH_m.x() += 2.0f * static_cast<float>(i / 2);
        pose.sequence = k;
        pose.clock_id = this_clock_id();
        pose.capture_time = mono_now();
        board.on_pose(Where::kCapture, ids[i], pose, mono_now());
      }
    }
  }

  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

class NoEvents final : public WindowEvents {
  void on_key(const KeyPress&) override {}
  void on_drag(WindowDrag, float, float) override {}
  void on_wheel(float) override {}
};

class Screen {
 public:
  explicit Screen(const BenchDisplayOptions& options)
      : period_(Duration::period_of_hz(options.hz)), begin_(mono_now()) {}

  Result<void> open(const BenchDisplayOptions& options) {
    if (!options.in_window) {
      DANCE_TRY(context_, OffscreenContext::create());
      return {};
    }
    DANCE_TRY(window_, ViewWindow::create({options.width_px, options.height_px}, events_));
    period_ = Duration::period_of_hz(window_->refresh_hz());
    return {};
  }
  void swap() {
    if (window_ != nullptr) {
      window_->poll_events();
      return window_->swap();
    }
    const Duration past = mono_now() - begin_;
    const std::int64_t turns = past.count_ns() / period_.count_ns();
    sleep_until(begin_ + period_ * (turns + 1));
  }
  void present(const StagePainter& painter) const {
    if (window_ != nullptr) painter.present();
    glFinish();
  }
  Duration period() const { return period_; }

 private:
  Duration period_;
  MonoTime begin_;
  NoEvents events_;
  std::unique_ptr<OffscreenContext> context_;
  std::unique_ptr<ViewWindow> window_;
};

class Run {
 public:
  Run(const BenchDisplayOptions& options, Screen& screen, StagePainter& painter, GuestBoard& board)
      : options_(options),
        screen_(screen),
        painter_(painter),
        roster_(board),
        path_(screen.period(), DisplayPath::Options()) {}

  Result<void> go_on(bool is_late, Duration how_long, BenchDisplayWay* way) {
    const MonoTime begin = mono_now();
    last_swap_ = MonoTime();
    for (MonoTime now = begin; now - begin < how_long; now = mono_now()) {
      const bool counts = way != nullptr && now - begin > kSettling;
      if (auto drawn = picture(is_late, counts ? way : nullptr); !drawn) return drawn;
    }
    return {};
  }
  int waited() const { return waited_; }
  int pictures() const { return pictures_; }

 private:
  Result<void> picture(bool is_late, BenchDisplayWay* way) {
    if (is_late) sleep_until(path_.when_to_take(mono_now()));
    PictureTimes times;
    times.taken = mono_now();
    roster_.update(times.taken, scene_);
    avatars_.dress(scene_);
    director_.update(scene_, {options_.width_px, options_.height_px, 0}, screen_.period());
    if (auto drawn = painter_.draw(director_.cells(), options_.width_px, options_.height_px, {});
        !drawn)
      return drawn;
    screen_.present(painter_);
    times.drawn = mono_now();
    screen_.swap();
    times.swapped = mono_now();
    ++pictures_;
    if (times.swapped - times.drawn > kWaits) ++waited_;
    if (is_late) path_.on_picture(times);
    if (way != nullptr) count(times, *way);
    last_swap_ = times.swapped;
    return {};
  }

  void count(const PictureTimes& times, BenchDisplayWay& way) {
    ++way.pictures;
    if (last_swap_.is_set()) {
      const double turns =
          (times.swapped - last_swap_).as_seconds() / screen_.period().as_seconds();
      if (turns > 1.5) way.skipped += static_cast<std::uint64_t>(turns - 0.5);
    }
    for (const StageRoster::Fresh& fresh : roster_.fresh()) {
      way.total_ms.push_back(static_cast<float>((times.swapped - fresh.pose.capture_time).as_ms()));
      way.coming_ms += (fresh.heard - fresh.pose.capture_time).as_ms();
      way.waiting_ms += (times.taken - fresh.heard).as_ms();
      way.drawing_ms += (times.drawn - times.taken).as_ms();
      way.swapping_ms += (times.swapped - times.drawn).as_ms();
    }
  }

  const BenchDisplayOptions& options_;
  Screen& screen_;
  StagePainter& painter_;
  StageRoster roster_;
  AvatarLibrary avatars_;
  ViewDirector director_{CameraPreset::kAuto};
  DisplayPath path_;
  SceneState scene_;
  MonoTime last_swap_;
  int waited_ = 0;
  int pictures_ = 0;
};

}  // namespace

Result<BenchDisplayResult> run_bench_display(const BenchDisplayOptions& options) {
  Screen screen(options);
  if (auto opened = screen.open(options); !opened) return tl::make_unexpected(opened.error());
  BenchDisplayResult result;
  result.renderer = renderer_name();
  const Quality quality = is_software_rendering() ? Quality::kLow : Quality::kHigh;
  DANCE_TRY(auto painter, StagePainter::create(quality, 1.0f));
  GuestBoard board(this_clock_id(), false);
  const Captures captures(options, board);
  Run run(options, screen, *painter, board);
  if (auto learnt = run.go_on(true, kLearning, nullptr); !learnt)
    return tl::make_unexpected(learnt.error());
  result.has_waiting_swap = run.waited() * 2 > run.pictures();
  const auto blocks = std::max(1, static_cast<int>(options.seconds / kBlock.as_seconds() / 2.0));
  for (int block = 0; block < blocks; ++block)
    for (const bool is_late : {false, true})
      if (auto ran = run.go_on(is_late, kBlock, is_late ? &result.late : &result.early); !ran)
        return tl::make_unexpected(ran.error());
  if (result.early.total_ms.empty() || result.late.total_ms.empty())
    return fail("no pose was drawn in this time; give more --seconds");
  return result;
}

}  // namespace dance
