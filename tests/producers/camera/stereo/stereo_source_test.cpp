#include "producers/camera/stereo/stereo_source.h"

#include <gtest/gtest.h>

#include <deque>

#include "producers/camera/stereo/row_check.h"
#include "producers/salsa/salsa_dancer.h"
#include "testing/camera/drawn_rig.h"
#include "testing/camera/stereo_dancer.h"

namespace dance {
namespace {

constexpr Duration kToFetch = Duration::ms(4);

// Gives what it is told to, without waiting: the deeds of a camera, one a call.
class ScriptedSource : public FrameSource {
 public:
  struct Deed {
    FrameState state;
    double ms;
  };
  ScriptedSource(std::string name, int width_px, int height_px, std::deque<Deed> deeds)
      : name_(std::move(name)),
        format_{width_px, height_px, 30.0, "drawn"},
        deeds_(std::move(deeds)),
        picture_(height_px, width_px, CV_8UC3) {}

  FrameState next(Duration, Frame& out) override {
    if (deeds_.empty()) return FrameState::kNone;
    const Deed deed = deeds_.front();
    deeds_.pop_front();
    if (deed.state != FrameState::kFrame) return deed.state;
    ++counters_.taken;
    out.image = picture_;
    out.capture_time = MonoTime::from_us(1'000'000 + static_cast<std::int64_t>(1e3 * deed.ms));
    out.fetched = out.capture_time + kToFetch;
    return deed.state;
  }
  const FrameFormat& format() const override { return format_; }
  const FrameCounters& counters() const override { return counters_; }
  const std::string& name() const override { return name_; }

 private:
  std::string name_;
  FrameFormat format_;
  FrameCounters counters_;
  std::deque<Deed> deeds_;
  cv::Mat picture_;
};

constexpr FrameState kFrame = FrameState::kFrame;

std::unique_ptr<StereoSource> paired(std::deque<ScriptedSource::Deed> left,
                                     std::deque<ScriptedSource::Deed> right) {
  return std::move(
      *make_paired(std::make_unique<ScriptedSource>("left", 640, 480, std::move(left)),
                   std::make_unique<ScriptedSource>("right", 640, 480, std::move(right))));
}

double skew_ms(const StereoFrame& frame) {
  return (frame.right.capture_time - frame.left.capture_time).as_ms();
}

TEST(StereoSource, SplitsSideBySideWithoutCopying) {
  auto both = make_side_by_side(std::make_unique<ScriptedSource>(
      "zed", 2560, 720, std::deque<ScriptedSource::Deed>{{kFrame, 0.0}}));
  ASSERT_TRUE(both) << both.error().what;
  EXPECT_EQ((*both)->format().width_px, 1280);
  StereoFrame frame;
  ASSERT_EQ((*both)->next(Duration(), frame), kFrame);
  EXPECT_EQ(frame.left.image.size(), cv::Size(1280, 720));
  EXPECT_EQ(frame.right.image.data, frame.left.image.data + std::size_t{3} * 1280);
  EXPECT_EQ((*both)->next(Duration(), frame), FrameState::kNone);
}

TEST(StereoSource, APictureThatHoldsNoTwoIsRefused) {
  const auto one = make_side_by_side(
      std::make_unique<ScriptedSource>("webcam", 1280, 720, std::deque<ScriptedSource::Deed>{}));
  ASSERT_FALSE(one);
  EXPECT_NE(one.error().what.find("webcam gives 1280 x 720"), std::string::npos);
  const auto differ = make_paired(
      std::make_unique<ScriptedSource>("a", 640, 480, std::deque<ScriptedSource::Deed>{}),
      std::make_unique<ScriptedSource>("b", 640, 360, std::deque<ScriptedSource::Deed>{}));
  ASSERT_FALSE(differ);
  EXPECT_NE(differ.error().what.find("--size"), std::string::npos);
}

TEST(StereoSource, PairsPicturesOfOneMoment) {
  const auto source = paired({{kFrame, 0.0}, {kFrame, 33.3}, {kFrame, 66.7}},
                             {{kFrame, 5.0}, {kFrame, 38.3}, {kFrame, 71.7}});
  StereoFrame frame;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(source->next(Duration(), frame), kFrame);
    EXPECT_NEAR(skew_ms(frame), 5.0, 1e-3);
  }
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kNone);
  EXPECT_EQ(source->counters().taken, 3u);
  EXPECT_EQ(source->unpaired(), 0u);
}

TEST(StereoSource, DropsAndCountsWhatHasNoPartner) {
  // The right eye lost two pictures, then the left one.
  const auto source = paired({{kFrame, 0.0}, {kFrame, 33.3}, {kFrame, 66.7}, {kFrame, 133.3}},
                             {{kFrame, 67.0}, {kFrame, 100.0}, {kFrame, 134.0}});
  StereoFrame frame;
  ASSERT_EQ(source->next(Duration(), frame), kFrame);
  EXPECT_NEAR(skew_ms(frame), 0.3, 1e-3);
  ASSERT_EQ(source->next(Duration(), frame), kFrame);
  EXPECT_NEAR(skew_ms(frame), 0.7, 1e-3);
  EXPECT_EQ(source->unpaired(), 3u);
}

TEST(StereoSource, APictureWaitsForItsPartnerOverCalls) {
  const auto source = paired({{kFrame, 0.0}}, {{FrameState::kNone, 0.0}, {kFrame, 1.0}});
  StereoFrame frame;
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kNone);
  EXPECT_EQ(source->next(Duration(), frame), kFrame);
}

TEST(StereoSource, SaysWhenTheLeftEyeIsGoneBackOrOver) {
  const auto source =
      paired({{FrameState::kGone, 0.0}, {FrameState::kBack, 0.0}, {kFrame, 300.0}, {kFrame, 333.3}},
             {{kFrame, 300.0}, {FrameState::kOver, 0.0}});
  StereoFrame frame;
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kGone);
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kBack);
  EXPECT_EQ(source->next(Duration(), frame), kFrame);
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kOver);
  EXPECT_EQ(source->unpaired(), 1u);
}

TEST(StereoSource, TheLeftEyeGoesOnAloneWhileTheRightOneIsGone) {
  const auto source =
      paired({{kFrame, 0.0}, {kFrame, 33.3}, {FrameState::kNone, 0.0}, {kFrame, 300.0}},
             {{FrameState::kGone, 0.0},
              {FrameState::kGone, 0.0},
              {FrameState::kGone, 0.0},
              {FrameState::kBack, 0.0},
              {kFrame, 301.0}});
  StereoFrame frame;
  EXPECT_EQ(source->trouble(), "");
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(source->next(Duration(), frame), kFrame) << i;
    EXPECT_FALSE(frame.left.image.empty());
    EXPECT_TRUE(frame.right.image.empty());
    EXPECT_NE(source->trouble().find("right is gone: left goes on alone"), std::string::npos);
  }
  EXPECT_EQ(source->next(Duration(), frame), FrameState::kNone);
  ASSERT_EQ(source->next(Duration(), frame), kFrame);
  EXPECT_FALSE(frame.right.image.empty());
  EXPECT_NEAR(skew_ms(frame), 1.0, 1e-3);
  EXPECT_EQ(frame.left.fetched, frame.right.capture_time + kToFetch) << "the later of both";
  EXPECT_EQ(source->trouble(), "");
  EXPECT_EQ(source->counters().taken, 3u);
  EXPECT_EQ(source->unpaired(), 2u);
}

TEST(StereoSource, AnEndlessMismatchDoesNotHang) {
  std::deque<ScriptedSource::Deed> left;
  std::deque<ScriptedSource::Deed> right;
  for (int i = 0; i < 1000; ++i) {
    left.push_back({kFrame, 40.0 * i});
    right.push_back({kFrame, 1e6 + 40.0 * i});
  }
  const auto source = paired(left, right);
  StereoFrame frame;
  EXPECT_EQ(source->next(Duration::s(100), frame), FrameState::kNone);
  EXPECT_GT(source->unpaired(), 0u);
}

TEST(StereoSource, SaysWhenTheEyesAreFarApartInTime) {
  std::deque<ScriptedSource::Deed> left;
  std::deque<ScriptedSource::Deed> right;
  for (int i = 0; i < 100; ++i) {
    left.push_back({kFrame, 33.3 * i});
    right.push_back({kFrame, 33.3 * i + 11.0});
  }
  const auto source = paired(left, right);
  StereoFrame frame;
  while (source->next(Duration(), frame) == kFrame)
    EXPECT_TRUE(source->counters().taken >= 60 || source->trouble().empty());
  EXPECT_NE(source->trouble().find("11.0 ms apart"), std::string::npos) << source->trouble();
}

class RowCheckTest : public ::testing::Test {
 protected:
  void SetUp() override {
    // Signs show where they are large.
    rig_.p_RL_m = {-0.12, 0.004, -0.002};
    StereoScene scene(rig_, SceneEyes{}, 3);
    SalsaDancer dancer(SalsaStyle{});
    Pose pose;
    dancer.dance_at(Duration::s(1), pose);
    BodyFrames body;
    forward_kinematics(dancer.skeleton(), pose, body);
    scene.draw(body_of(body, StageCamera{}, DancerLook{}), left_, right_);
  }
  StereoRig rig_ = drawn_rig();
  cv::Mat left_;
  cv::Mat right_;
};

TEST_F(RowCheckTest, AGoodRigHasItsRows) {
  const RowCheck rows = check_rows(left_, right_, rig_);
  EXPECT_GE(rows.points, 40);
  EXPECT_LT(rows.residual_px, 0.3);
  EXPECT_NEAR(rows.offset_px, 0.0, 0.2);
}

TEST_F(RowCheckTest, SettlesWhicheverWayTheSignsWereWritten) {
  for (const RigReading written : {RigReading::kAsWritten, RigReading::kTranslationOther,
                                   RigReading::kRotationOther, RigReading::kBothOther}) {
    const SettledRig settled = settle_signs(left_, right_, read_otherwise(rig_, written));
    EXPECT_TRUE(settled.is_sure) << text_of(written) << ": " << settled.rows.residual_px;
    EXPECT_LT(settled.rows.residual_px, 0.6) << text_of(written);
    EXPECT_LT((settled.rig.R_RL - rig_.R_RL).norm(), 1e-9)
        << text_of(written) << ", got " << text_of(settled.reading);
  }
}

TEST_F(RowCheckTest, AnotherCamerasFileIsNoGoodOne) {
  StereoRig other = rig_;
  other.right.cy_px += 9.0;
  other.left.distortion[0] = 0.1;
  const SettledRig settled = settle_signs(left_, right_, other);
  EXPECT_FALSE(settled.is_sure);
  EXPECT_FALSE(settle_signs(right_, left_, rig_).is_sure);
}

}  // namespace
}  // namespace dance
