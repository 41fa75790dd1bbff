#include "producers/capture_eyes.h"

#include "producers/camera/files/open_frame_source.h"
#include "producers/camera/stereo/calibration_file.h"

namespace dance {
namespace {

class OneEye : public CaptureEyes {
 public:
  OneEye(std::unique_ptr<FrameSource> source, const Pinhole& camera) : source_(std::move(source)) {
    format_ = source_->format();
    camera_ = camera;
  }
  FrameState next(Duration patience, EyesFrame& out) override {
    out.right.release();
    return source_->next(patience, out.left);
  }
  const FrameCounters& counters() const override { return source_->counters(); }
  const std::string& name() const override { return source_->name(); }

 private:
  std::unique_ptr<FrameSource> source_;
};

SourceOptions source_options(const CaptureOptions& options, const CameraWish& wish) {
  SourceOptions wished;
  wished.camera = wish;
  wished.play.loops = options.loops;
  wished.play.hz = options.hz;
  return wished;
}

}  // namespace

Result<std::unique_ptr<CaptureEyes>> CaptureEyes::open(const CaptureOptions& options) {
  DANCE_TRY(const CameraWish wish, camera_wish(options));
  DANCE_TRY(auto source, open_frame_source(options.source, source_options(options, wish)));
  const FrameFormat& format = source->format();
  Pinhole camera = assumed_pinhole(format.width_px, format.height_px, options.fov_deg);
  if (!options.calibration.empty()) {
    DANCE_TRY(const Calibration calibration,
              load_calibration(options.calibration, format.width_px, format.height_px));
    camera = calibration.camera;
  }
  return std::make_unique<OneEye>(std::move(source), camera);
}

}  // namespace dance
