// ChessboardCalibration: one camera or two calibrated with a chessboard: it takes pictures as they
// come, keeps those that add information, reports what is still to be shown, and solves.
//
// Units/frames: pixels; millimetres of the board's squares in, metres out.
// Ownership:    keeps corners, no pictures; at most kMostBoardViews of them.
// Threads:      none inside; one owner. add() takes tens of milliseconds, solve() up to some
//               seconds.
// Failure:      solve() says which views are missing, or what is wrong with the result.
// Source:       Zhang: A flexible new technique for camera calibration, 2000, in OpenCV's
//               calibrateCamera and stereoCalibrate.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "producers/camera/stereo/chessboard.h"
#include "producers/camera/stereo/stereo_rig.h"

namespace dance {

constexpr std::size_t kMostBoardViews = 60;
constexpr std::size_t kFewestBoardViews = 6;

struct ChessboardOptions {
  BoardShape board;
  int cameras = 1;
  // Of pictures that come as a film: waits until the board is held still.
  bool wants_stillness = false;
};

enum class BoardAdded { kKept, kNoBoard, kOneCameraOnly, kMoving, kSimilar, kFull, kOtherSize };
// As text for people: "no board seen".
const char* text_of(BoardAdded added);

struct CalibrationReport {
  Calibration calibration;
  double rms_px =
      0.0;  // reprojection error over all corners that were kept; of two cameras the larger
  std::vector<double> view_rms_px;    // of the views that were kept
  std::vector<std::size_t> dropped;   // views that did not fit the others
  double focal_spread_percent = 0.0;  // standard deviation of the focal length, of the worse camera
  double epipolar_rms_px = 0.0;  // of two cameras: between the rows in which they see one corner
  double square_mm = 0.0;    // of two cameras: what they measure of the board's squares, on average
  bool is_complete = false;  // all views that a calibration needs were shown
  bool is_good = false;      // by its numbers
  std::string judgement;     // one line: good, usable, or what to do better
};

class ChessboardCalibration {
 public:
  static Result<ChessboardCalibration> make(const ChessboardOptions& options);

  BoardAdded add(const cv::Mat& picture);
  BoardAdded add(const cv::Mat& left, const cv::Mat& right);

  std::size_t views() const { return views_.size(); }
  bool has_enough() const { return coverage_.is_complete(); }
  // One line for people: how far it is, and what to show next.
  std::string progress() const;
  // Of the last picture, for drawing; empty where no board was seen.
  const std::vector<cv::Point2f>& last_corners() const { return last_; }

  Result<CalibrationReport> solve() const;

 private:
  struct View {
    std::vector<cv::Point2f> corners[2];
    BoardView held;
  };
  explicit ChessboardCalibration(const ChessboardOptions& options) : options_(options) {}
  BoardAdded keep(std::vector<cv::Point2f> left, std::vector<cv::Point2f> right, cv::Size picture);

  ChessboardOptions options_;
  cv::Size picture_;
  std::vector<View> views_;
  std::vector<cv::Point2f> last_;
  BoardCoverage coverage_;
};

}  // namespace dance
