#include "producers/camera/stereo/chessboard.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace dance {
namespace {

// The search is done on a picture of at most this width: its time grows with the picture, its
// success does not.
constexpr int kSearchWidth_px = 800;
constexpr double kTilted = 0.09;  // a side is by a tenth longer
constexpr int kViewsEachWay = 2;
constexpr double kNearSize = 0.40;
constexpr double kFarSize = 0.35;
// Corners of the board that make a ninth of the picture known.
constexpr int kCornersPerCell = 12;

double length(const cv::Point2f& a, const cv::Point2f& b) { return cv::norm(a - b); }

}  // namespace

std::optional<std::vector<cv::Point2f>> find_board(const cv::Mat& picture,
                                                   const BoardShape& shape) {
  if (picture.empty()) return std::nullopt;
  cv::Mat grey = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  const double shrink = std::min(1.0, static_cast<double>(kSearchWidth_px) / grey.cols);
  cv::Mat small = grey;
  if (shrink < 1.0) cv::resize(grey, small, cv::Size(), shrink, shrink, cv::INTER_AREA);
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCorners(
          small, cv::Size(shape.columns, shape.rows), corners,
          cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK))
    return std::nullopt;
  for (cv::Point2f& corner : corners)
    corner =
        (corner + cv::Point2f(0.5f, 0.5f)) / static_cast<float>(shrink) - cv::Point2f(0.5f, 0.5f);
  // The window stays within the squares that meet in the corner.
  double least = 1e9;
  for (int r = 0; r < shape.rows; ++r)
    for (int c = 0; c + 1 < shape.columns; ++c) {
      const auto i = static_cast<std::size_t>(r * shape.columns + c);
      least = std::min(least, length(corners[i], corners[i + 1]));
      if (r + 1 < shape.rows)
        least = std::min(least,
                         length(corners[i], corners[i + static_cast<std::size_t>(shape.columns)]));
    }
  const int window = std::clamp(static_cast<int>(0.4 * least), 2, 11);
  cv::cornerSubPix(grey, corners, cv::Size(window, window), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 40, 0.005));
  return corners;
}

void match_order(const std::vector<cv::Point2f>& left, std::vector<cv::Point2f>& right) {
  if ((left.back() - left.front()).dot(right.back() - right.front()) < 0.0f)
    std::reverse(right.begin(), right.end());
}

BoardView view_of_board(const std::vector<cv::Point2f>& corners, const BoardShape& shape,
                        cv::Size picture) {
  const auto at = [&](int row, int column) {
    return corners[static_cast<std::size_t>(row * shape.columns + column)];
  };
  cv::Point2f a = at(0, 0);
  cv::Point2f b = at(0, shape.columns - 1);
  cv::Point2f c = at(shape.rows - 1, shape.columns - 1);
  cv::Point2f d = at(shape.rows - 1, 0);
  // As it stands in the picture: a upper left, b upper right, c lower right, d lower left.
  const cv::Point2f middle = 0.25f * (a + b + c + d);
  cv::Point2f around[4] = {a, b, c, d};
  std::sort(std::begin(around), std::end(around), [&](const cv::Point2f& p, const cv::Point2f& q) {
    return std::atan2(p.y - middle.y, p.x - middle.x) < std::atan2(q.y - middle.y, q.x - middle.x);
  });
  const auto* upper_left = std::min_element(
      std::begin(around), std::end(around),
      [](const cv::Point2f& p, const cv::Point2f& q) { return p.x + p.y < q.x + q.y; });
  const auto first = upper_left - std::begin(around);
  a = around[first];
  b = around[(first + 1) % 4];
  c = around[(first + 2) % 4];
  d = around[(first + 3) % 4];
  BoardView view;
  view.x = middle.x / static_cast<float>(picture.width);
  view.y = middle.y / static_cast<float>(picture.height);
  view.size = 0.5 * (length(a, c) + length(b, d)) / std::hypot(picture.width, picture.height);
  const auto ratio = [](double p, double q) {
    return std::log(std::max(p, 1.0) / std::max(q, 1.0));
  };
  view.lean = ratio(length(a, d), length(b, c));
  view.pitch = ratio(length(a, b), length(d, c));
  view.roll_rad = std::atan2(b.y - a.y, b.x - a.x);
  return view;
}

bool is_similar(const BoardView& a, const BoardView& b) {
  return std::abs(a.x - b.x) < 0.07 && std::abs(a.y - b.y) < 0.07 &&
         std::abs(a.size - b.size) < 0.06 && std::abs(a.lean - b.lean) < 0.06 &&
         std::abs(a.pitch - b.pitch) < 0.06 && std::abs(a.roll_rad - b.roll_rad) < 0.2;
}

void BoardCoverage::add(const std::vector<cv::Point2f>& corners, const BoardView& view,
                        cv::Size picture) {
  ++views_;
  for (const cv::Point2f& corner : corners) {
    const int column = std::clamp(
        static_cast<int>(kCells * corner.x / static_cast<float>(picture.width)), 0, kCells - 1);
    const int row = std::clamp(
        static_cast<int>(kCells * corner.y / static_cast<float>(picture.height)), 0, kCells - 1);
    ++cells_[row][column];
  }
  near_ += view.size > kNearSize ? 1 : 0;
  far_ += view.size < kFarSize ? 1 : 0;
  leans_[0] += view.lean > kTilted ? 1 : 0;
  leans_[1] += view.lean < -kTilted ? 1 : 0;
  pitches_[0] += view.pitch > kTilted ? 1 : 0;
  pitches_[1] += view.pitch < -kTilted ? 1 : 0;
}

std::vector<std::string> BoardCoverage::missing() const {
  static constexpr const char* kPlaces[kCells][kCells] = {
      {"the upper left corner", "the upper edge", "the upper right corner"},
      {"the left edge", "the middle", "the right edge"},
      {"the lower left corner", "the lower edge", "the lower right corner"}};
  std::vector<std::string> out;
  const auto want = [&](bool is_missing, const std::string& what) {
    if (is_missing) out.push_back(what);
  };
  want(leans_[0] < kViewsEachWay, "the board turned, its left side nearer");
  want(leans_[1] < kViewsEachWay, "the board turned, its right side nearer");
  want(pitches_[0] < kViewsEachWay, "the board leaned, its upper side nearer");
  want(pitches_[1] < kViewsEachWay, "the board leaned, its lower side nearer");
  want(near_ < kViewsEachWay, "the board near, so that it fills half the picture");
  want(far_ < kViewsEachWay, "the board farther away");
  for (int row = 0; row < kCells; ++row)
    for (int column = 0; column < kCells; ++column)
      want(cells_[row][column] < kCornersPerCell,
           std::string("the board in ") + kPlaces[row][column] + " of the picture");
  if (out.empty() && views_ < kLeastViews) out.emplace_back("the board held in any other way");
  return out;
}

}  // namespace dance
