#include "producers/camera/program/capture_input.h"

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

class SingleCamera : public CaptureInput {
 public:
  explicit SingleCamera(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {
    format_ = source_->format();
  }
  FrameState next(Duration timeout, CaptureFrame& out) override {
    out.right.release();
    return source_->next(timeout, out.left);
  }
  FrameCounters counters() const override { return source_->counters(); }
  const std::string& name() const override { return source_->name(); }
  std::string line() const override { return line_on(*source_); }
  int cameras() const override { return 1; }

 private:
  std::unique_ptr<FrameSource> source_;
};

class StereoCamera : public CaptureInput {
 public:
  explicit StereoCamera(std::unique_ptr<StereoSource> source) : source_(std::move(source)) {
    format_ = source_->format();
  }
  FrameState next(Duration timeout, CaptureFrame& out) override {
    const FrameState state = source_->next(timeout, pair_);
    out.left = pair_.left;
    out.right = pair_.right.image;
    return state;
  }
  FrameCounters counters() const override { return source_->counters(); }
  const std::string& name() const override { return source_->name(); }
  std::string line() const override {
    return fmt::format("{}: {}x{} {} at {:g} Hz of each camera", source_->name(), format_.width_px,
                       format_.height_px, format_.encoding, format_.hz);
  }
  int cameras() const override { return 2; }
  std::string trouble() const override { return source_->trouble(); }

 private:
  std::unique_ptr<StereoSource> source_;
  StereoFrame pair_;
};

// Makers write the pose of the cameras relative to each other in either direction: the pictures
// decide.
StereoRig settled(CaptureInput& input, const StereoRig& rig) {
  CaptureFrame seen;
  FrameState state = FrameState::kNone;
  for (int look = 0; look < 60 && state != FrameState::kFrame && state != FrameState::kOver; ++look)
    state = input.next(Duration::ms(50), seen);
  if (state != FrameState::kFrame || seen.right.empty()) return rig;
  const SettledRig settled = settle_signs(seen.left.image, seen.right, rig);
  if (settled.reading != RigReading::kAsWritten)
    talk::info("{}: the calibration is read {}: so its rows fit", input.name(),
               text_of(settled.reading));
  if (!settled.is_sure)
    talk::warn(
        "{}: the same points do not lie in the same rows of both pictures ({} points, {:.1f} px "
        "off); is this "
        "the file of this camera, and is "
        "there light? --calibrate makes a new one",
        input.name(), settled.rows.points, settled.rows.residual_px);
  return settled.rig;
}

// With a stereo calibration a camera with several sizes is opened at one with both views.
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

Result<std::unique_ptr<CaptureInput>> CaptureInput::open_uncalibrated(
    const CaptureOptions& options) {
  SourceOptions wished;
  DANCE_TRY(wished.camera, camera_wish(options));
  wish_for_both(options, wished.camera);
  // Pictures of a calibration were chosen one by one; all else is as if it happened now.
  const bool is_live = options.calibrate_file.empty() || !picture_files({options.source});
  wished.play = {is_live, options.loops, options.hz};
  DANCE_TRY(auto source, open_frame_source(options.source, wished));
  std::unique_ptr<CaptureInput> input;
  if (!options.right.empty()) {
    DANCE_TRY(auto right, open_frame_source(options.right, wished));
    DANCE_TRY(auto pair, make_paired(std::move(source), std::move(right)));
    input = std::make_unique<StereoCamera>(std::move(pair));
  } else if (source->format().width_px > kTwoPictures * source->format().height_px) {
    DANCE_TRY(auto pair, make_side_by_side(std::move(source)));
    input = std::make_unique<StereoCamera>(std::move(pair));
  } else {
    input = std::make_unique<SingleCamera>(std::move(source));
  }
  input->is_live_ = is_live;
  input->calibration_ = options.calibration;
  input->fov_deg_ = options.fov_deg;
  input->camera_ =
      assumed_pinhole(input->format_.width_px, input->format_.height_px, options.fov_deg);
  return input;
}

Result<void> CaptureInput::take_size(int width_px, int height_px) {
  if (cameras() == 2)
    return fail(
        name() +
        ": pictures of another size came; two cameras keep theirs. Start dance capture again");
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

Result<std::unique_ptr<CaptureInput>> CaptureInput::open(const CaptureOptions& options) {
  DANCE_TRY(auto input, open_uncalibrated(options));
  if (!options.calibration.empty()) {
    DANCE_TRY(
        const Calibration calibration,
        load_calibration(options.calibration, input->format_.width_px, input->format_.height_px));
    input->camera_ = calibration.camera;
    if (input->cameras() == 2 && calibration.pair) input->rig_ = settled(*input, *calibration.pair);
  }
  if (input->cameras() == 2 && !input->rig_)
    talk::warn(
        "{} has two cameras, and no calibration of the pair is known: only the left one is "
        "used; give --calibration, or "
        "make one with --calibrate",
        input->name());
  return input;
}

}  // namespace dance
