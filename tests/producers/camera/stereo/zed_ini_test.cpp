#include "producers/camera/stereo/zed_ini.h"

#include <gtest/gtest.h>

#include <clocale>

#include "tests/test_folder.h"

namespace dance {
namespace {

std::string zed_file(const std::string& name) {
  return text_of(DANCE_SOURCE_DIR "/tests/producers/camera/stereo/zed_corpus/" + name);
}

std::string without(std::string text, const std::string& line_begin, const std::string& instead) {
  const std::size_t at = text.find("\n" + line_begin);
  EXPECT_NE(at, std::string::npos) << line_begin;
  return text.replace(at + 1, text.find('\n', at + 1) - at - 1, instead);
}

TEST(ZedIni, ReadsTheSectionOfThePicturesSize) {
  const auto rig = parse_zed_ini(zed_file("whole.conf"), "SN1.conf", 1280, 720);
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_DOUBLE_EQ(rig->left.fx_px, 700.12);
  EXPECT_DOUBLE_EQ(rig->right.cy_px, 367.401);
  EXPECT_DOUBLE_EQ(rig->left.distortion[0], -0.172004);
  EXPECT_DOUBLE_EQ(rig->right.distortion[3], 0.000499);
  EXPECT_TRUE(rig->left.is_measured);
  // The right eye is at (+Baseline, TY, TZ): OpenCV's T is the way back.
  EXPECT_TRUE(rig->p_RL_m.isApprox(Eigen::Vector3d(-0.1198, 0.00031, -0.00112)));
  EXPECT_NEAR(rig->R_RL(0, 2), 0.0119, 2e-5);
}

TEST(ZedIni, TakesTranslationsWithAndWithoutTheSizesSuffix) {
  const auto one = parse_zed_ini(zed_file("whole.conf"), "a", 1280, 720);
  const auto other = parse_zed_ini(zed_file("suffixes.conf"), "b", 1280, 720);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->p_RL_m, other->p_RL_m);
  const auto large = parse_zed_ini(zed_file("suffixes.conf"), "b", 2208, 1242);
  ASSERT_TRUE(large);
  EXPECT_NEAR(large->p_RL_m.y(), 0.00030, 1e-12);
}

TEST(ZedIni, ScalesFromTheNextLargerSizeOfTheSameShape) {
  const auto rig = parse_zed_ini(zed_file("whole.conf"), "a", 640, 360);
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->left.width_px, 640);
  EXPECT_NEAR(rig->left.fx_px, 350.06, 1e-9);
  EXPECT_NEAR(rig->left.cx_px, (652.31 + 0.5) / 2 - 0.5, 1e-9);
  const auto full = parse_zed_ini(zed_file("whole.conf"), "a", 1920, 1080);
  ASSERT_TRUE(full) << full.error().what;
  EXPECT_NEAR(full->left.fx_px, 1399.74 * 1920 / 2208, 1e-9);
}

TEST(ZedIni, OldFilesMayEndWithTheSecondCoefficient) {
  const auto rig = parse_zed_ini(zed_file("whole.conf"), "a", 672, 376);
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->left.distortion, (std::array<double, 5>{-0.1722, 0.0262, 0, 0, 0}));
}

TEST(ZedIni, NamesSectionAndKeyOfWhatIsMissing) {
  for (const std::string key : {"fx", "fy", "cx", "cy", "k1", "k2"}) {
    std::string text = zed_file("whole.conf");
    const std::size_t section = text.find("[RIGHT_CAM_HD]");
    const std::size_t at = text.find("\n" + key + "=", section);
    text.replace(at + 1, 2, "no");
    const auto rig = parse_zed_ini(text, "SN1.conf", 1280, 720);
    ASSERT_FALSE(rig) << key;
    EXPECT_NE(rig.error().what.find("SN1.conf: [RIGHT_CAM_HD] has no " + key), std::string::npos)
        << rig.error().what;
  }
  for (const std::string key : {"Baseline", "TY", "TZ", "RX_HD", "CV_HD", "RZ_HD"}) {
    const auto rig =
        parse_zed_ini(without(zed_file("whole.conf"), key + "=", ""), "SN1.conf", 1280, 720);
    ASSERT_FALSE(rig) << key;
    EXPECT_NE(rig.error().what.find("[STEREO]"), std::string::npos) << rig.error().what;
    EXPECT_NE(rig.error().what.find(key), std::string::npos) << rig.error().what;
  }
}

TEST(ZedIni, RefusesAbsurdNumbers) {
  const std::string good = zed_file("whole.conf");
  for (const std::string bad : {"Baseline=0", "Baseline=-120", "Baseline=9e9", "Baseline=nan",
                                "Baseline=", "Baseline=12O", "Baseline=119,8"}) {
    const auto rig = parse_zed_ini(without(good, "Baseline=", bad), "SN1.conf", 1280, 720);
    ASSERT_FALSE(rig) << bad;
    EXPECT_NE(rig.error().what.find("Baseline"), std::string::npos) << rig.error().what;
  }
  EXPECT_FALSE(parse_zed_ini(without(good, "CV_HD=", "CV_HD=0.9"), "a", 1280, 720));
  EXPECT_FALSE(parse_zed_ini(without(good, "TY=", "TY=90"), "a", 1280, 720));
  EXPECT_FALSE(parse_zed_ini(without(good, "fx=700.12", "fx=7"), "a", 1280, 720));
  EXPECT_FALSE(parse_zed_ini(without(good, "cx=652.31", "cx=-3"), "a", 1280, 720));
}

TEST(ZedIni, SaysWhichSizesThereAreForAnotherShape) {
  const auto rig = parse_zed_ini(zed_file("whole.conf"), "SN1.conf", 640, 480);
  ASSERT_FALSE(rig);
  EXPECT_NE(rig.error().what.find("640 x 480"), std::string::npos);
  EXPECT_NE(rig.error().what.find("1280x720"), std::string::npos);
}

TEST(ZedIni, ReadsNumbersWithPointsWhereverTheMachineStands) {
  // Not every machine has it; where it is not there the test says the same with the C locale.
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
  const auto rig = parse_zed_ini(zed_file("whole.conf"), "a", 1280, 720);
  std::setlocale(LC_NUMERIC, before.c_str());
  ASSERT_TRUE(rig);
  EXPECT_DOUBLE_EQ(rig->left.fx_px, 700.12);
}

TEST(ZedIni, RefusesWhatIsLargerThanSuchAFile) {
  std::string text = zed_file("whole.conf");
  text.resize(kMostZedIni_bytes + 1, '\n');
  EXPECT_FALSE(parse_zed_ini(text, "a", 1280, 720));
}

}  // namespace
}  // namespace dance
