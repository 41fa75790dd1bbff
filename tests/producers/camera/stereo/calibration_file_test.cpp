#include "producers/camera/stereo/calibration_file.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>

#include "testing/camera/drawn_rig.h"
#include "testing/camera/stereo_dancer.h"
#include "tests/producers/camera/stereo/opencv_doc.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

class CalibrationFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "calibration_file_" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& text) {
    const std::string path = folder_ + "/file.yml";
    std::ofstream(path) << text;
    return path;
  }
  std::string folder_;
};

void expect_same(const Pinhole& a, const Pinhole& b) {
  EXPECT_EQ(a.width_px, b.width_px);
  EXPECT_EQ(a.height_px, b.height_px);
  EXPECT_NEAR(a.fx_px, b.fx_px, 1e-9);
  EXPECT_NEAR(a.fy_px, b.fy_px, 1e-9);
  EXPECT_NEAR(a.cx_px, b.cx_px, 1e-9);
  EXPECT_NEAR(a.cy_px, b.cy_px, 1e-9);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(a.distortion[i], b.distortion[i], 1e-12);
}

TEST_F(CalibrationFile, WhatWasSavedComesBack) {
  const StereoRig rig = drawn_rig();
  const std::string path = folder_ + "/pair.yml";
  ASSERT_TRUE(save_calibration(path, {rig.left, rig}, 0.25));
  const auto read = load_calibration(path, 1280, 720);
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_TRUE(read->pair);
  expect_same(read->camera, rig.left);
  expect_same(read->pair->right, rig.right);
  EXPECT_TRUE(read->pair->R_RL.isApprox(rig.R_RL, 1e-12));
  EXPECT_TRUE(read->pair->p_RL_m.isApprox(rig.p_RL_m, 1e-12));

  ASSERT_TRUE(save_calibration(path, {rig.right, std::nullopt}, 0.25));
  const auto one = load_calibration(path, 640, 360);
  ASSERT_TRUE(one) << one.error().what;
  EXPECT_FALSE(one->pair);
  EXPECT_NEAR(one->camera.fx_px, 0.5 * rig.right.fx_px, 1e-9);
  EXPECT_NEAR(one->camera.cx_px, 0.5 * (rig.right.cx_px + 0.5) - 0.5, 1e-9);
  // Nothing is left beside it.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(CalibrationFile, AFileThatCannotBeWrittenLeavesTheOldOne) {
  const auto saved = save_calibration(folder_ + "/none/pair.yml", {drawn_rig().left, {}}, 0.1);
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().what.find("none/pair.yml"), std::string::npos);
  std::filesystem::create_directory(folder_ + "/taken");
  EXPECT_FALSE(save_calibration(folder_ + "/taken", {drawn_rig().left, {}}, 0.1));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(CalibrationFile, AnotherShapeOfPictureIsRefused) {
  const std::string path = folder_ + "/one.yml";
  ASSERT_TRUE(save_calibration(path, {drawn_rig().left, {}}, 0.1));
  const auto read = load_calibration(path, 640, 480);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().what.find("1280 x 720"), std::string::npos) << read.error().what;
}

TEST_F(CalibrationFile, SaysWhatIsWrongWithAFile) {
  const auto expect = [&](const std::string& text, const std::string& part) {
    const auto read = load_calibration(write(text), 640, 480);
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().what.find(part), std::string::npos) << read.error().what;
    EXPECT_NE(read.error().what.find("file.yml"), std::string::npos) << read.error().what;
  };
  const std::string head = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n";
  const std::string d =
      "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ 0., "
      "0., 0., 0., 0. ]\n";
  const auto k = [](const std::string& data) {
    return "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ " + data +
           " ]\n";
  };
  const std::string good = k("500., 0., 320., 0., 500., 240., 0., 0., 1.");
  ASSERT_TRUE(load_calibration(write(head + good + d), 640, 480));
  expect("", "empty");
  expect("hello\n", "file.yml");
  expect("%YAML:1.0\n---\nfoo: 1\n", "camera_matrix");
  expect("%YAML:1.0\n---\n" + good + d, "image_width");
  expect(head + good, "distortion_coefficients");
  expect(head + k("5., 0., 320., 0., 500., 240., 0., 0., 1.") + d, "fx");
  expect(head + k("500., 0., 9320., 0., 500., 240., 0., 0., 1.") + d, "outside");
  expect(head + k(".NaN, 0., 320., 0., 500., 240., 0., 0., 1.") + d, "fx");
  EXPECT_FALSE(load_calibration(folder_ + "/nothing.yml", 640, 480));
  EXPECT_FALSE(load_calibration(folder_, 640, 480));
}

TEST_F(CalibrationFile, MillimetresAndSwappedEyesAreToldApart) {
  StereoRig rig = drawn_rig();
  rig.p_RL_m *= 1000.0;
  const auto far = checked(rig, "a.yml");
  ASSERT_FALSE(far);
  EXPECT_NE(far.error().what.find("millimetres"), std::string::npos) << far.error().what;
  rig = drawn_rig();
  rig.p_RL_m = -rig.p_RL_m;
  const auto swapped = checked(rig, "a.yml");
  ASSERT_FALSE(swapped);
  EXPECT_NE(swapped.error().what.find("swap"), std::string::npos) << swapped.error().what;
}

TEST_F(CalibrationFile, RecognisesAZed) {
  const auto read = load_calibration(
      DANCE_SOURCE_DIR "/tests/producers/camera/stereo/zed_corpus/whole.conf", 1280, 720);
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_TRUE(read->pair);
  EXPECT_DOUBLE_EQ(read->camera.fx_px, 700.12);
}

TEST_F(CalibrationFile, DamagedFilesAreErrorsAndNothingWorse) {
  const StereoRig rig = drawn_rig();
  const std::string path = folder_ + "/pair.yml";
  ASSERT_TRUE(save_calibration(path, {rig.left, rig}, 0.25));
  const std::string whole = text_of(path);
  int read = 0;
  for (std::size_t i = 0; i < whole.size(); i += 7) {
    read += parse_opencv_calibration(whole.substr(0, i), "cut").has_value() ? 1 : 0;
    std::string flipped = whole;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 7)));
    const auto damaged = parse_opencv_calibration(flipped, "flipped");
    EXPECT_TRUE(!damaged || checked(damaged->camera, "x"));
  }
  EXPECT_LT(read, 4);
}

TEST_F(CalibrationFile, ReadsWhatOpenCvsOwnProgramWrote) {
  const std::string folder = opencv_doc_folder();
  if (folder.empty()) GTEST_SKIP() << kNoOpencvDoc;
  const auto read = load_calibration(folder + "/left_intrinsics.yml", 640, 480);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_NEAR(read->camera.fx_px, 535.91573396163199, 1e-9);
  EXPECT_NEAR(read->camera.distortion[4], 0.23839153080878486, 1e-12);
}

}  // namespace
}  // namespace dance
