#include "producers/camera/program/capture_eyes.h"

#include <fmt/core.h>

#include <array>

#include "core/program/talk.h"
#include "producers/camera/files/open_frame_source.h"
#include "producers/camera/stereo/calibration_file.h"
#include "producers/camera/stereo/row_check.h"
#include "producers/camera/stereo/stereo_source.h"

namespace dance {
namespace {

// Wider than any film: two pictures side by side; two of 4:3 are 2.67.
constexpr double kTwoPictures = 2.6;

class OneEye : public CaptureEyes {
 public:
  explicit OneEye(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {
    format_ = source_->format();
  }
  FrameState next(Duration patience, EyesFrame& out) override {
    out.right.release();
    return source_->next(patience, out.left);
  }
  FrameCounters counters() const override { return source_->counters(); }
  const std::string& name() const override { return source_->name(); }
  std::string line() const override { return line_on(*source_); }
  int eyes() const override { return 1; }

 private:
  std::unique_ptr<FrameSource> source_;
};

class TwoEyes : public CaptureEyes {
 public:
  explicit TwoEyes(std::unique_ptr<StereoSource> source) : source_(std::move(source)) {
    format_ = source_->format();
  }
  FrameState next(Duration patience, EyesFrame& out) override {
    const FrameState state = source_->next(patience, pair_);
    out.left = pair_.left;
    out.right = pair_.right.image;
    return state;
  }
  FrameCounters counters() const override { return source_->counters(); }
  const std::string& name() const override { return source_->name(); }
  std::string line() const override {
    return fmt::format("{}: {}x{} {} at {:g} Hz of each eye", source_->name(), format_.width_px,
                       format_.height_px, format_.encoding, format_.hz);
  }
  int eyes() const override { return 2; }
  std::string trouble() const override { return source_->trouble(); }

 private:
  std::unique_ptr<StereoSource> source_;
  StereoFrame pair_;
};

// Makers write down how eyes stand to each other one way or the other: what the eyes see decides.
StereoRig settled(CaptureEyes& eyes, const StereoRig& rig) {
  EyesFrame seen;
  FrameState state = FrameState::kNone;
  for (int look = 0; look < 60 && state != FrameState::kFrame && state != FrameState::kOver; ++look)
    state = eyes.next(Duration::ms(50), seen);
  if (state != FrameState::kFrame || seen.right.empty()) return rig;
  const SettledRig settled = settle_signs(seen.left.image, seen.right, rig);
  if (settled.reading != RigReading::kAsWritten)
    talk::info("{}: the calibration is read {}: so its rows fit", eyes.name(),
               text_of(settled.reading));
  if (!settled.is_sure)
    talk::warn(
        "{}: what both eyes see does not lie in the same rows ({} points, {:.1f} px off); is this "
        "the file of this camera, and is "
        "there light? --calibrate makes a new one",
        eyes.name(), settled.rows.points, settled.rows.residual_px);
  return settled.rig;
}

// Who has a calibration of two eyes wants both of them from a camera that gives several sizes.
void wish_for_both(const CaptureOptions& options, CameraWish& wish) {
  constexpr std::array<std::array<int, 2>, 6> kUsualSizes{
      {{1280, 720}, {1920, 1080}, {672, 376}, {640, 480}, {2208, 1242}, {640, 360}}};
  if (wish.width_px || options.calibration.empty() || !options.right.empty()) return;
  for (const auto& [width, height] : kUsualSizes) {
    const auto calibration = load_calibration(options.calibration, width, height);
    if (!calibration || !calibration->pair) continue;
    wish.width_px = 2 * width;
    wish.height_px = height;
    return;
  }
}

}  // namespace

Result<std::unique_ptr<CaptureEyes>> CaptureEyes::open_uncalibrated(const CaptureOptions& options) {
  SourceOptions wished;
  DANCE_TRY(wished.camera, camera_wish(options));
  wish_for_both(options, wished.camera);
  // Pictures of a calibration were chosen one by one; all else is as if it happened now.
  const bool is_live = options.calibrate_file.empty() || !picture_files({options.source});
  wished.play = {is_live, options.loops, options.hz};
  DANCE_TRY(auto source, open_frame_source(options.source, wished));
  std::unique_ptr<CaptureEyes> eyes;
  if (!options.right.empty()) {
    DANCE_TRY(auto right, open_frame_source(options.right, wished));
    DANCE_TRY(auto pair, make_paired(std::move(source), std::move(right)));
    eyes = std::make_unique<TwoEyes>(std::move(pair));
  } else if (source->format().width_px > kTwoPictures * source->format().height_px) {
    DANCE_TRY(auto pair, make_side_by_side(std::move(source)));
    eyes = std::make_unique<TwoEyes>(std::move(pair));
  } else {
    eyes = std::make_unique<OneEye>(std::move(source));
  }
  eyes->is_live_ = is_live;
  eyes->calibration_ = options.calibration;
  eyes->fov_deg_ = options.fov_deg;
  eyes->camera_ = assumed_pinhole(eyes->format_.width_px, eyes->format_.height_px, options.fov_deg);
  return eyes;
}

Result<void> CaptureEyes::take_size(int width_px, int height_px) {
  if (eyes() == 2)
    return fail(name() +
                ": pictures of another size came; two eyes keep theirs. Start dance capture anew");
  Pinhole camera = assumed_pinhole(width_px, height_px, fov_deg_);
  if (!calibration_.empty()) {
    DANCE_TRY(const Calibration calibration, load_calibration(calibration_, width_px, height_px));
    camera = calibration.camera;
  }
  format_.width_px = width_px;
  format_.height_px = height_px;
  camera_ = camera;
  return {};
}

Result<std::unique_ptr<CaptureEyes>> CaptureEyes::open(const CaptureOptions& options) {
  DANCE_TRY(auto eyes, open_uncalibrated(options));
  if (!options.calibration.empty()) {
    DANCE_TRY(
        const Calibration calibration,
        load_calibration(options.calibration, eyes->format_.width_px, eyes->format_.height_px));
    eyes->camera_ = calibration.camera;
    if (eyes->eyes() == 2 && calibration.pair) eyes->rig_ = settled(*eyes, *calibration.pair);
  }
  if (eyes->eyes() == 2 && !eyes->rig_)
    talk::warn(
        "{} has two eyes, and nothing says how they stand to each other: only the left one is "
        "used; give --calibration, or "
        "make one with --calibrate",
        eyes->name());
  return eyes;
}

}  // namespace dance
