#include "producers/camera/stereo/chessboard_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "producers/camera/stereo/rectified_pair.h"

namespace dance {
namespace {

// A view this many times worse than the median is none of the board as it was.
constexpr double kOutlier = 2.5;
constexpr double kLeastOutlier_px = 0.3;
constexpr double kMostDropped = 0.34;

std::vector<cv::Point3f> board_points(const BoardShape& board) {
  std::vector<cv::Point3f> out;
  const auto side_m = static_cast<float>(1e-3 * board.square_mm);
  for (int r = 0; r < board.rows; ++r)
    for (int c = 0; c < board.columns; ++c)
      out.emplace_back(side_m * static_cast<float>(c), side_m * static_cast<float>(r), 0.0f);
  return out;
}

struct CameraSolution {
  cv::Mat_<double> matrix;
  cv::Mat_<double> distortion;
  double rms_px = 0.0;
  std::vector<double> view_rms_px;
  double focal_spread_percent = 0.0;
};

CameraSolution solve_camera(const BoardCorners& corners, int side,
                            const std::vector<std::size_t>& kept, int flags) {
  std::vector<std::vector<cv::Point2f>> points;
  for (const std::size_t i : kept) points.push_back(corners.views[side][i]);
  const std::vector<std::vector<cv::Point3f>> board(kept.size(), board_points(corners.board));
  CameraSolution out;
  cv::Mat spreads;
  cv::Mat outer_spreads;
  cv::Mat view_errors;
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> places;
  out.rms_px = cv::calibrateCamera(board, points, corners.picture, out.matrix, out.distortion,
                                   turns, places, spreads, outer_spreads, view_errors, flags);
  out.focal_spread_percent = 100.0 * spreads.at<double>(0) / out.matrix(0, 0);
  for (int i = 0; i < static_cast<int>(kept.size()); ++i)
    out.view_rms_px.push_back(view_errors.at<double>(i));
  return out;
}

// The third radial coefficient where the lens has it: on others it is noise that bends the
// picture's corners.
CameraSolution solve_camera(const BoardCorners& corners, int side,
                            const std::vector<std::size_t>& kept) {
  constexpr double kWorthIt = 0.95;
  CameraSolution plain = solve_camera(corners, side, kept, cv::CALIB_FIX_K3);
  CameraSolution rich = solve_camera(corners, side, kept, 0);
  return rich.rms_px < kWorthIt * plain.rms_px ? rich : plain;
}

Pinhole pinhole_of(const CameraSolution& solution, cv::Size picture) {
  Pinhole out;
  out.width_px = picture.width;
  out.height_px = picture.height;
  out.fx_px = solution.matrix(0, 0);
  out.fy_px = solution.matrix(1, 1);
  out.cx_px = solution.matrix(0, 2);
  out.cy_px = solution.matrix(1, 2);
  for (std::size_t i = 0; i < 5 && i < solution.distortion.total(); ++i)
    out.distortion[i] = solution.distortion.at<double>(static_cast<int>(i));
  out.is_measured = true;
  return out;
}

// Takes out the worst view that is an outlier; false where none is, or enough are out.
bool drop_worst(std::vector<std::size_t>& kept, std::vector<std::size_t>& dropped,
                const std::vector<double>& errors) {
  const std::size_t all = kept.size() + dropped.size();
  if (kept.size() <= kFewestBoardViews ||
      static_cast<double>(dropped.size() + 1) > kMostDropped * static_cast<double>(all))
    return false;
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[sorted.size() / 2];
  const auto worst = std::max_element(errors.begin(), errors.end());
  if (*worst < std::max(kOutlier * median, kLeastOutlier_px)) return false;
  const auto at = kept.begin() + (worst - errors.begin());
  dropped.push_back(*at);
  kept.erase(at);
  return true;
}

struct PairSolution {
  cv::Mat_<double> turn;
  cv::Mat_<double> place;
  std::vector<double> view_rms_px;
};

PairSolution solve_pair(const BoardCorners& corners, const std::vector<std::size_t>& kept,
                        CameraSolution solutions[2]) {
  std::vector<std::vector<cv::Point2f>> points[2];
  for (const std::size_t i : kept)
    for (int side = 0; side < 2; ++side) points[side].push_back(corners.views[side][i]);
  const std::vector<std::vector<cv::Point3f>> board(kept.size(), board_points(corners.board));
  PairSolution out;
  cv::Mat essential;
  cv::Mat fundamental;
  cv::Mat errors;
  cv::stereoCalibrate(board, points[0], points[1], solutions[0].matrix, solutions[0].distortion,
                      solutions[1].matrix, solutions[1].distortion, corners.picture, out.turn,
                      out.place, essential, fundamental, errors, cv::CALIB_FIX_INTRINSIC,
                      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-7));
  for (int i = 0; i < errors.rows; ++i)
    out.view_rms_px.push_back(std::max(errors.at<double>(i, 0), errors.at<double>(i, 1)));
  return out;
}

// What the pair makes of the board itself: rows that should be one, squares that have a known side.
void measure_pair(const BoardCorners& corners, const std::vector<std::size_t>& kept,
                  CalibrationReport& report) {
  const RectifiedPair pair(*report.calibration.pair);
  double rows = 0.0;
  double sides_m = 0.0;
  int points = 0;
  int sides = 0;
  for (const std::size_t i : kept) {
    std::vector<Eigen::Vector3d> seen;
    for (std::size_t k = 0; k < corners.views[0][i].size(); ++k) {
      const cv::Point2f& l = corners.views[0][i][k];
      const cv::Point2f& r = corners.views[1][i][k];
      const Eigen::Vector2d left = pair.rectified(Side::kLeft, {l.x, l.y});
      const Eigen::Vector2d right = pair.rectified(Side::kRight, {r.x, r.y});
      rows += (left.y() - right.y()) * (left.y() - right.y());
      ++points;
      seen.push_back(pair.p_L_m(left, left.x() - right.x()));
      if (static_cast<int>(k) % corners.board.columns == 0) continue;
      sides_m += (seen[k] - seen[k - 1]).norm();
      ++sides;
    }
  }
  report.epipolar_rms_px = std::sqrt(rows / points);
  report.square_mm = 1e3 * sides_m / sides;
}

void judge(const BoardCorners& corners, CalibrationReport& report) {
  // What is good at a width of 1280, larger pictures may exceed.
  const double width = std::max(1.0, corners.picture.width / 1280.0);
  const double rms = report.rms_px / width;
  report.judgement = fmt::format("reprojection error {:.2f} px, focal length to {:.2f} %",
                                 report.rms_px, report.focal_spread_percent);
  const char* word = rms < 0.4 ? "good" : rms < 0.8 ? "usable" : "poor";
  report.is_good = rms < 0.8 && report.focal_spread_percent < 1.0;
  if (report.calibration.pair) {
    const double rows = report.epipolar_rms_px / width;
    const double squares = std::abs(report.square_mm / corners.board.square_mm - 1.0);
    report.judgement += fmt::format(
        ", solutions {:.1f} mm apart, rows to {:.2f} px, squares measured as {:.2f} mm",
        1e3 * report.calibration.pair->baseline_m(), report.epipolar_rms_px, report.square_mm);
    if (rows > 0.5) word = rows < 1.0 ? "usable" : "poor";
    if (rows > 1.0 || squares > 0.01) report.is_good = false;
  }
  if (!report.is_good)
    report.judgement = "poor: " + report.judgement +
                       "; is the board flat, sharp, of the stated columns, rows and squares?";
  else
    report.judgement = std::string(word) + ": " + report.judgement;
}

}  // namespace

Result<CalibrationReport> solve_chessboard(const BoardCorners& corners) try {
  const bool is_pair = !corners.views[1].empty();
  std::vector<std::size_t> kept(corners.views[0].size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  CalibrationReport report;
  CameraSolution solutions[2];
  PairSolution pair;
  std::vector<double> errors;
  do {
    solutions[0] = solve_camera(corners, 0, kept);
    errors = solutions[0].view_rms_px;
    if (!is_pair) continue;
    solutions[1] = solve_camera(corners, 1, kept);
    pair = solve_pair(corners, kept, solutions);
    for (std::size_t i = 0; i < errors.size(); ++i)
      errors[i] = std::max({errors[i], solutions[1].view_rms_px[i], pair.view_rms_px[i]});
  } while (drop_worst(kept, report.dropped, errors));

  std::sort(report.dropped.begin(), report.dropped.end());
  report.view_rms_px = errors;
  report.rms_px =
      is_pair ? std::max(solutions[0].rms_px, solutions[1].rms_px) : solutions[0].rms_px;
  report.focal_spread_percent = solutions[0].focal_spread_percent;
  DANCE_TRY(report.calibration.camera,
            checked(pinhole_of(solutions[0], corners.picture), "this calibration"));
  if (is_pair) {
    report.focal_spread_percent =
        std::max(report.focal_spread_percent, solutions[1].focal_spread_percent);
    StereoRig rig;
    rig.left = report.calibration.camera;
    rig.right = pinhole_of(solutions[1], corners.picture);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) rig.R_RL(i, j) = pair.turn(i, j);
      rig.p_RL_m(i) = pair.place(i, 0);
    }
    DANCE_TRY(report.calibration.pair, checked(rig, "this calibration"));
    measure_pair(corners, kept, report);
  }
  judge(corners, report);
  return report;
} catch (const cv::Exception&) {
  return fail("the views of the chessboard make no camera: show the board from more sides");
}

}  // namespace dance
