#include "producers/camera/program/capture_calibrate.h"

#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/program/talk.h"
#include "producers/camera/program/capture_input.h"
#include "producers/camera/program/capture_preview.h"
#include "producers/camera/stereo/calibration_file.h"
#include "producers/camera/stereo/chessboard_calibration.h"
#include "producers/camera/view/overlay.h"

namespace dance {
namespace {

constexpr Duration kProgressEvery = Duration::s(2);

// What the camera sees with the board's corners in it, for the preview.
class BoardPreview {
 public:
  void show(Preview& preview, const Frame& frame, const BoardShape& board,
            const std::vector<cv::Point2f>& corners, const std::string& caption) {
    frame.image.copyTo(drawn_.image);
    drawn_.capture_time = frame.capture_time;
    draw_board(drawn_.image, board.columns, board.rows, corners);
    preview.show(drawn_, {}, caption);
  }

 private:
  Frame drawn_;
};

Result<void> solve_and_save(const CaptureOptions& options, const ChessboardCalibration& board) {
  talk::info("{} views; solving", board.views());
  DANCE_TRY(const CalibrationReport report, board.solve());
  if (report.is_good)
    talk::info("{}", report.judgement);
  else
    talk::warn("{}; it is kept, as it is better than none", report.judgement);
  if (!report.dropped.empty())
    talk::info("{} views did not fit the others and were left out", report.dropped.size());
  const Pinhole& camera = report.calibration.camera;
  talk::info("focal length {:.1f} px of {} x {}, reprojection error {:.2f} px", camera.fx_px,
             camera.width_px, camera.height_px, report.rms_px);
  if (report.calibration.pair)
    talk::info("two cameras, {:.1f} mm apart; rows agree to {:.2f} px",
               1e3 * report.calibration.pair->baseline_m(), report.epipolar_rms_px);
  if (auto saved = save_calibration(options.calibrate_file, report.calibration, report.rms_px);
      !saved)
    return saved;
  talk::info("written to {}; use it with --calibration {}", options.calibrate_file,
             options.calibrate_file);
  return {};
}

}  // namespace

Result<void> calibrate_camera(const CaptureOptions& options) {
  ChessboardOptions wished;
  DANCE_TRY(const auto shape, parse_pair("--board", options.board));
  wished.board = {shape.first, shape.second, options.square_mm};
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto input, CaptureInput::open_uncalibrated(options));
  wished.cameras = input->cameras();
  // A board that is held before a camera moves; pictures from a folder were chosen.
  wished.wants_stillness = input->is_live();
  DANCE_TRY(auto board, ChessboardCalibration::make(wished));
  DANCE_TRY(auto preview, open_preview(options, PreviewSide::kAsTheCameraSees,
                                       "calibration of " + input->name()));
  BoardPreview drawing;
  talk::info("{}: show a chessboard of {} inner corners, held still in many places and tilts",
             input->name(), options.board);
  CaptureFrame seen;
  MonoTime next_progress;
  bool is_gone = false;
  while (!poller->is_stopped() && !board.has_enough()) {
    const FrameState state = input->next(Duration::ms(50), seen);
    poller->run_once(Duration());
    if (state == FrameState::kOver) break;
    if (state == FrameState::kGone && !is_gone)
      talk::warn("{} is gone; plug it in again, it is looked for", input->name());
    if (state == FrameState::kBack) talk::info("{} is back", input->name());
    if (state != FrameState::kNone) is_gone = state == FrameState::kGone;
    if (state != FrameState::kFrame) continue;
    const BoardAdded added =
        wished.cameras == 2 ? board.add(seen.left.image, seen.right) : board.add(seen.left.image);
    const MonoTime now = mono_now();
    if (added == BoardAdded::kKept || now >= next_progress) {
      if (input->is_live() || added == BoardAdded::kKept)
        talk::info("{}; {}", text_of(added), board.progress());
      next_progress = now + kProgressEvery;
    }
    if (preview)
      drawing.show(*preview, seen.left, wished.board, board.last_corners(), board.progress());
    if (preview && preview->was_closed()) break;
  }
  return solve_and_save(options, board);
}

}  // namespace dance
