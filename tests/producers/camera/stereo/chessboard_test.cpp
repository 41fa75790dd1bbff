#include <gtest/gtest.h>

#include "producers/camera/stereo/calibration_file.h"
#include "producers/camera/stereo/chessboard_calibration.h"
#include "testing/camera/drawn_board.h"
#include "tests/producers/camera/files/written_pictures.h"
#include "tests/producers/camera/stereo/opencv_doc.h"

namespace dance {
namespace {

constexpr BoardShape kDrawn{9, 6, 30.0};
const Pinhole kLens{640, 480, 520.4, 519.1, 331.7, 233.2, {-0.21, 0.07, 0.0011, -0.0008, 0.0},
                    true};

StereoRig small_rig() {
  StereoRig rig;
  rig.left = kLens;
  rig.right = {640, 480, 515.9, 516.6, 311.2, 246.0, {-0.20, 0.06, -0.0005, 0.0007, 0.0}, true};
  rig.R_RL =
      Eigen::AngleAxisd(0.021, Eigen::Vector3d(0.3, 0.9, -0.2).normalized()).toRotationMatrix();
  rig.p_RL_m = {-0.0642, 0.0007, -0.0012};
  return rig;
}

ChessboardCalibration of(int eyes, BoardShape shape) {
  return *ChessboardCalibration::make({shape, eyes, false});
}

TEST(Chessboard, AKnownCameraComesBack) {
  const DrawnBoardPainter painter(kLens);
  ChessboardCalibration calibration = of(1, kDrawn);
  std::uint64_t seed = 1;
  for (const BoardPlace& place : ways_to_hold(kLens, kDrawn))
    EXPECT_EQ(calibration.add(painter.draw(kDrawn, place, seed++)), BoardAdded::kKept) << seed;
  EXPECT_TRUE(calibration.has_enough()) << calibration.progress();
  const auto report = calibration.solve();
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_TRUE(report->is_good && report->is_complete) << report->judgement;
  EXPECT_LT(report->rms_px, 0.15);
  EXPECT_TRUE(report->dropped.empty());
  const Pinhole& got = report->calibration.camera;
  EXPECT_NEAR(got.fx_px, kLens.fx_px, 0.002 * kLens.fx_px);
  EXPECT_NEAR(got.fy_px, kLens.fy_px, 0.002 * kLens.fy_px);
  EXPECT_NEAR(got.cx_px, kLens.cx_px, 1.5);
  EXPECT_NEAR(got.cy_px, kLens.cy_px, 1.5);
  EXPECT_NEAR(got.distortion[0], kLens.distortion[0], 0.02);
}

TEST(Chessboard, AKnownPairComesBack) {
  const StereoRig rig = small_rig();
  const DrawnBoardPainter left(rig.left);
  const DrawnBoardPainter right(rig.right);
  ChessboardCalibration calibration = of(2, kDrawn);
  std::uint64_t seed = 1;
  for (BoardPlace place : ways_to_hold(kLens, kDrawn)) {
    // What the left eye sees in its corner the right one has to see as well.
    place.p_CB_m.x() += 0.03;
    calibration.add(left.draw(kDrawn, place, seed),
                    right.draw(kDrawn, in_right_eye(rig, place), seed + 100));
    ++seed;
  }
  ASSERT_GE(calibration.views(), 10u);
  const auto report = calibration.solve();
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_LT(report->rms_px, 0.15);
  EXPECT_LT(report->epipolar_rms_px, 0.2);
  EXPECT_NEAR(report->square_mm, 30.0, 0.1);
  ASSERT_TRUE(report->calibration.pair);
  const StereoRig& got = *report->calibration.pair;
  EXPECT_NEAR(got.baseline_m(), rig.baseline_m(), 0.0004);
  EXPECT_LT(Eigen::AngleAxisd(got.R_RL * rig.R_RL.transpose()).angle(), 0.003);
  EXPECT_NEAR(got.right.fx_px, rig.right.fx_px, 0.004 * rig.right.fx_px);
}

TEST(Chessboard, SaysWhatIsStillToBeShown) {
  const DrawnBoardPainter painter(kLens);
  ChessboardCalibration calibration = of(1, kDrawn);
  const auto ways = ways_to_hold(kLens, kDrawn);
  EXPECT_NE(calibration.progress().find("0 views; show the board turned"), std::string::npos)
      << calibration.progress();
  const auto early = calibration.solve();
  ASSERT_FALSE(early);
  EXPECT_NE(early.error().what.find("too few"), std::string::npos) << early.error().what;
  const cv::Mat first = painter.draw(kDrawn, ways[1], 1);
  EXPECT_EQ(calibration.add(first), BoardAdded::kKept);
  EXPECT_EQ(calibration.add(first), BoardAdded::kSimilar);
  EXPECT_EQ(calibration.add(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90))), BoardAdded::kNoBoard);
  EXPECT_TRUE(calibration.last_corners().empty());
  EXPECT_EQ(calibration.views(), 1u);
  // All whose right side is nearer: the other is asked for, and a calibration of them is no good
  // one.
  for (const std::size_t i : {0u, 3u, 4u, 5u, 7u, 9u, 10u})
    EXPECT_EQ(calibration.add(painter.draw(kDrawn, ways[i], i)), BoardAdded::kKept);
  EXPECT_FALSE(calibration.has_enough());
  EXPECT_NE(calibration.progress().find("left side nearer"), std::string::npos)
      << calibration.progress();
  const auto report = calibration.solve();
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_FALSE(report->is_complete);
  EXPECT_NE(report->judgement.find("not all was shown"), std::string::npos);
}

TEST(Chessboard, WaitsForABoardThatIsHeldStill) {
  const DrawnBoardPainter painter(kLens);
  auto calibration = *ChessboardCalibration::make({kDrawn, 1, true});
  auto place = ways_to_hold(kLens, kDrawn)[0];
  EXPECT_EQ(calibration.add(painter.draw(kDrawn, place, 1)), BoardAdded::kMoving);
  place.p_CB_m.x() += 0.02;
  EXPECT_EQ(calibration.add(painter.draw(kDrawn, place, 2)), BoardAdded::kMoving);
  EXPECT_EQ(calibration.add(painter.draw(kDrawn, place, 3)), BoardAdded::kKept);
}

TEST(Chessboard, AViewOfABentBoardIsDropped) {
  Pinhole lens = kLens;
  lens.distortion = {0.3, 0.1, 0.02, 0.02, 0.0};
  const DrawnBoardPainter painter(kLens);
  const DrawnBoardPainter bent(lens);
  ChessboardCalibration calibration = of(1, kDrawn);
  std::uint64_t seed = 1;
  for (const BoardPlace& place : ways_to_hold(kLens, kDrawn)) {
    // One of them is seen through another lens.
    const DrawnBoardPainter& eye = seed == 4 ? bent : painter;
    calibration.add(eye.draw(kDrawn, place, seed++));
  }
  const auto report = calibration.solve();
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->dropped, std::vector<std::size_t>{3});
  EXPECT_LT(report->rms_px, 0.15);
}

TEST(Chessboard, RefusesBoardsThatAreNone) {
  EXPECT_FALSE(ChessboardCalibration::make({{2, 6, 25.0}, 1, false}));
  EXPECT_FALSE(ChessboardCalibration::make({{9, 6, 0.0}, 1, false}));
  EXPECT_FALSE(ChessboardCalibration::make({{9, 6, 25.0}, 3, false}));
}

class OpencvDocBoards : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = opencv_doc_folder();
    if (folder_.empty()) GTEST_SKIP() << kNoOpencvDoc;
  }
  cv::Mat picture(const char* eye, int i) const {
    return grey_picture(folder_ + "/" + eye + (i < 10 ? "0" : "") + std::to_string(i) + ".jpg");
  }
  static std::vector<int> numbers() { return {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14}; }
  std::string folder_;
};

TEST_F(OpencvDocBoards, OneCameraAsItsKnownCalibrationSays) {
  ChessboardCalibration calibration = of(1, {9, 6, 25.0});
  for (const int i : numbers()) calibration.add(picture("left", i));
  ASSERT_GE(calibration.views(), 11u);
  const auto report = calibration.solve();
  ASSERT_TRUE(report) << report.error().what;
  const auto known = load_calibration(folder_ + "/left_intrinsics.yml", 640, 480);
  ASSERT_TRUE(known);
  const Pinhole& got = report->calibration.camera;
  std::printf("[ measured ] %zu views, %zu dropped; %s; fx %.2f px, known %.2f\n",
              calibration.views(), report->dropped.size(), report->judgement.c_str(), got.fx_px,
              known->camera.fx_px);
  // The known one has a view of 1.2 px, and came to 0.39 px.
  EXPECT_LT(report->rms_px, 0.39);
  EXPECT_NEAR(got.fx_px, known->camera.fx_px, 0.01 * got.fx_px);
  EXPECT_NEAR(got.cx_px, known->camera.cx_px, 6.0);
  EXPECT_NEAR(got.cy_px, known->camera.cy_px, 6.0);
  EXPECT_NEAR(got.distortion[0], known->camera.distortion[0], 0.05);
}

TEST_F(OpencvDocBoards, TwoEyesMeasureTheBoardsSquares) {
  ChessboardCalibration calibration = of(2, {9, 6, 25.0});
  for (const int i : numbers()) calibration.add(picture("left", i), picture("right", i));
  ASSERT_GE(calibration.views(), 10u);
  const auto report = calibration.solve();
  ASSERT_TRUE(report) << report.error().what;
  std::printf("[ measured ] %zu views, %zu dropped; %s\n", calibration.views(),
              report->dropped.size(), report->judgement.c_str());
  EXPECT_LT(report->rms_px, 0.4);
  EXPECT_LT(report->epipolar_rms_px, 0.5);
  EXPECT_NEAR(report->square_mm, 25.0, 0.2);
  // OpenCV's sample says 3.34 squares of one: 83 mm.
  EXPECT_NEAR(report->calibration.pair->baseline_m(), 0.0834, 0.003);
}

}  // namespace
}  // namespace dance
