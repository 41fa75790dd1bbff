#include "producers/camera/stereo/chessboard_calibration.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/assert.h"
#include "producers/camera/stereo/chessboard_solver.h"

namespace dance {
namespace {

// Of a board that is held still, at a width of 1280; hands shake by less.
constexpr double kStill_px = 1.5;

double mean_step_px(const std::vector<cv::Point2f>& a, const std::vector<cv::Point2f>& b) {
  if (a.size() != b.size() || a.empty()) return 1e9;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += cv::norm(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

}  // namespace

const char* text_of(BoardAdded added) {
  switch (added) {
    case BoardAdded::kKept:
      return "kept";
    case BoardAdded::kNoBoard:
      return "no whole board seen: show all of it, flat, well lit, with its white rim";
    case BoardAdded::kOneCameraOnly:
      return "only one side sees the whole board: move it to where both do";
    case BoardAdded::kMoving:
      return "hold the board still";
    case BoardAdded::kSimilar:
      return "like an earlier view: turn, lean or move the board";
    case BoardAdded::kFull:
      return "no room for more views";
    case BoardAdded::kOtherSize:
      return "the picture is of another size than the first";
  }
  return "";
}

Result<ChessboardCalibration> ChessboardCalibration::make(const ChessboardOptions& options) {
  const BoardShape& board = options.board;
  if (board.columns < 3 || board.rows < 3 || board.columns > 40 || board.rows > 40)
    return fail(
        fmt::format("a board of {} x {} inner corners: count the points where four squares "
                    "meet, 3 to 40 each way",
                    board.columns, board.rows));
  if (!(board.square_mm >= 1.0 && board.square_mm <= 1000.0))
    return fail(
        fmt::format("squares of {} mm: measure one with a ruler, 1 to 1000 mm", board.square_mm));
  if (options.cameras != 1 && options.cameras != 2)
    return fail(fmt::format("{} cameras can not be calibrated: 1 or 2", options.cameras));
  return ChessboardCalibration(options);
}

BoardAdded ChessboardCalibration::add(const cv::Mat& picture) {
  DANCE_ASSERT(options_.cameras == 1);
  auto corners = find_board(picture, options_.board);
  if (!corners) {
    last_.clear();
    return BoardAdded::kNoBoard;
  }
  return keep(std::move(*corners), {}, picture.size());
}

BoardAdded ChessboardCalibration::add(const cv::Mat& left, const cv::Mat& right) {
  DANCE_ASSERT(options_.cameras == 2);
  if (left.size() != right.size()) return BoardAdded::kOtherSize;
  auto in_left = find_board(left, options_.board);
  auto in_right = find_board(right, options_.board);
  if (!in_left || !in_right) {
    last_.clear();
    return in_left || in_right ? BoardAdded::kOneCameraOnly : BoardAdded::kNoBoard;
  }
  match_order(*in_left, *in_right);
  return keep(std::move(*in_left), std::move(*in_right), left.size());
}

BoardAdded ChessboardCalibration::keep(std::vector<cv::Point2f> left,
                                       std::vector<cv::Point2f> right, cv::Size picture) {
  if (picture_.area() == 0) picture_ = picture;
  if (picture != picture_) return BoardAdded::kOtherSize;
  const double step_px = mean_step_px(left, last_);
  last_ = left;
  if (views_.size() >= kMostBoardViews) return BoardAdded::kFull;
  if (options_.wants_stillness && step_px > kStill_px * picture.width / 1280.0)
    return BoardAdded::kMoving;
  const BoardView held = view_of_board(left, options_.board, picture);
  for (const View& view : views_)
    if (is_similar(view.held, held)) return BoardAdded::kSimilar;
  coverage_.add(left, held, picture);
  views_.push_back({{std::move(left), std::move(right)}, held});
  return BoardAdded::kKept;
}

std::string ChessboardCalibration::progress() const {
  const std::vector<std::string> missing = coverage_.missing();
  const std::string count = fmt::format("{} view{}", views_.size(), views_.size() == 1 ? "" : "s");
  if (missing.empty()) return count + ", enough";
  const std::size_t more = missing.size() - 1;
  return fmt::format("{}; show {}{}", count, missing.front(),
                     more == 0 ? std::string() : fmt::format(" ({} more to come)", more));
}

Result<CalibrationReport> ChessboardCalibration::solve() const {
  if (views_.size() < kFewestBoardViews)
    return fail(fmt::format("{} views of the chessboard are too few, {} the least: {}",
                            views_.size(), kFewestBoardViews, progress()));
  BoardCorners corners{options_.board, picture_, {}};
  for (const View& view : views_)
    for (int side = 0; side < options_.cameras; ++side)
      corners.views[side].push_back(view.corners[side]);
  DANCE_TRY(CalibrationReport report, solve_chessboard(corners));
  report.is_complete = has_enough();
  if (!report.is_complete)
    report.judgement =
        "as far as it goes " + report.judgement + "; not all was shown: " + progress();
  return report;
}

}  // namespace dance
