// A chessboard in a picture: where its corners are, and how it is held, so that a calibration gets
// views that differ.
//
// Units/frames: pixels; inner corners, row by row. Places and sizes of a BoardView are parts of the
//               picture's.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      find_board() gives nullopt where the whole board is not seen.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace dance {

struct BoardShape {
  int columns = 9;  // inner corners, where four squares meet
  int rows = 6;
  double square_mm = 25.0;
  int corners() const { return columns * rows; }
};

std::optional<std::vector<cv::Point2f>> find_board(const cv::Mat& picture, const BoardShape& shape);

// Boards look the same from two sides: the order of the right camera's corners as that of the
// left's.
void match_order(const std::vector<cv::Point2f>& left, std::vector<cv::Point2f>& right);

// How a board is held, from the shape that it has in the picture.
struct BoardView {
  double x = 0.0;  // of its middle, 0…1
  double y = 0.0;
  double size = 0.0;  // its diagonal over the picture's
  double lean =
      0.0;  // logarithm of its left side's length over the right's: positive, the left is nearer
  double pitch = 0.0;  // of the upper over the lower
  double roll_rad = 0.0;
};
BoardView view_of_board(const std::vector<cv::Point2f>& corners, const BoardShape& shape,
                        cv::Size picture);
bool is_similar(const BoardView& a, const BoardView& b);

// Which parts of a picture and which ways of holding have been seen.
class BoardCoverage {
 public:
  static constexpr int kLeastViews = 12;

  void add(const std::vector<cv::Point2f>& corners, const BoardView& view, cv::Size picture);
  bool is_complete() const { return missing().empty(); }
  // Text for people on what is to be shown next, the most needed first: "the upper left corner of
  // the picture".
  std::vector<std::string> missing() const;
  int views() const { return views_; }

 private:
  static constexpr int kCells = 3;
  int views_ = 0;
  int cells_[kCells][kCells] = {};  // corners seen there, row by row
  int near_ = 0;
  int far_ = 0;
  int leans_[2] = {};    // left side nearer, right side nearer
  int pitches_[2] = {};  // upper, lower
};

}  // namespace dance
