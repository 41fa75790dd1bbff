#include "producers/camera/view/dancer_advice.h"

#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/producers/camera/view/standing_body.h"

namespace dance {
namespace {

const cv::Mat kLit(200, 160, CV_8UC3, cv::Scalar(90, 110, 120));
const cv::Mat kDark(200, 160, CV_8UC3, cv::Scalar(4, 3, 5));

// All that is said while the same is seen for so long, 30 pictures a second.
std::vector<std::string> said_in(DancerAdvice& advice, MonoTime& t, double seconds,
                                 const cv::Mat& picture, BodyLandmarks body) {
  std::vector<std::string> lines;
  for (int i = 0; i < static_cast<int>(seconds * 30.0); ++i) {
    t = t + Duration::ms(33);
    body.capture_time = t;
    const std::string_view line = advice.see(picture, body);
    if (!line.empty()) lines.emplace_back(line);
  }
  return lines;
}

// Below the picture's lower edge.
BodyLandmarks without_feet() {
  BodyLandmarks body = standing_body();
  for (std::size_t i = index_of(Landmark::kLeftAnkle); i < kLandmarkCount; ++i) {
    body.image_px[i].y() += 40.0f;
    body.visibility[i] = 0.1f;
  }
  return body;
}

// Above its upper edge, where the network is sure of it all the same.
BodyLandmarks without_head() {
  BodyLandmarks body = standing_body();
  for (Eigen::Vector3f& point : body.image_px) point.y() -= 20.0f;
  return body;
}

// As behind a table.
BodyLandmarks without_legs() {
  BodyLandmarks body = standing_body();
  for (std::size_t i = index_of(Landmark::kLeftKnee); i < kLandmarkCount; ++i)
    body.visibility[i] = 0.15f;
  return body;
}

TEST(DancerAdvice, SaysOnceThatNobodyIsThereAndOnceThatSomebodyIs) {
  DancerAdvice advice;
  MonoTime t = MonoTime::from_us(1);
  const auto nobody = said_in(advice, t, 10.0, kLit, BodyLandmarks{});
  ASSERT_EQ(nobody.size(), 1u);
  EXPECT_NE(nobody[0].find("nobody"), std::string::npos);
  const auto there = said_in(advice, t, 10.0, kLit, standing_body());
  ASSERT_EQ(there.size(), 1u);
  EXPECT_NE(there[0].find("seen"), std::string::npos);
}

TEST(DancerAdvice, TellsACoveredLensFromAnEmptyRoom) {
  DancerAdvice advice;
  MonoTime t = MonoTime::from_us(1);
  said_in(advice, t, 1.0, kLit, standing_body());
  const auto covered = said_in(advice, t, 3.0, kDark, BodyLandmarks{});
  ASSERT_EQ(covered.size(), 1u);
  EXPECT_NE(covered[0].find("lens"), std::string::npos);
}

TEST(DancerAdvice, MissesTheFeetButNotForAMoment) {
  DancerAdvice advice;
  MonoTime t = MonoTime::from_us(1);
  said_in(advice, t, 1.0, kLit, standing_body());
  EXPECT_TRUE(said_in(advice, t, 1.0, kLit, without_feet()).empty());
  EXPECT_TRUE(said_in(advice, t, 1.0, kLit, standing_body()).empty()) << "nothing had been said";
  const auto cut_off = said_in(advice, t, 3.0, kLit, without_feet());
  ASSERT_EQ(cut_off.size(), 1u);
  EXPECT_NE(cut_off[0].find("feet"), std::string::npos);
}

TEST(DancerAdvice, SaysWhatIsMissingOfOneWhoIsNotSeenWhole) {
  for (const auto& [body, word] : {std::pair{without_head(), "the head is not in the picture"},
                                   std::pair{without_legs(), "something hides the legs"}}) {
    DancerAdvice advice;
    MonoTime t = MonoTime::from_us(1);
    const auto said = said_in(advice, t, 3.0, kLit, body);
    ASSERT_EQ(said.size(), 1u) << word;
    EXPECT_NE(said[0].find(word), std::string::npos) << said[0];
  }
}

TEST(DancerAdvice, AllocatesNothing) {
  DancerAdvice advice;
  BodyLandmarks body = standing_body();
  AllocationGuard guard;
  for (int i = 1; i < 200; ++i) {
    body.capture_time = MonoTime::from_us(i * 33'000);
    body.found = i < 100;
    advice.see(kDark, body);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
