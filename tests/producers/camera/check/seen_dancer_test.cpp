// What a dancer is told, of drawn dances before simulated cameras, and of a filmed person.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "producers/camera/advice/camera_advice.h"
#include "producers/camera/check/picture_light.h"
#include "producers/camera/check/view_shake.h"
#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/seen_body.h"
#include "producers/camera/view/dancer_advice.h"
#include "tests/formats/camera_view/drawn_view.h"
#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/files/written_pictures.h"
#include "tests/producers/camera/solver/seen_dance.h"

namespace dance {
namespace {

// What is said, and for how many pictures.
using Said = std::map<Text, int>;

void count(const CameraAdvice& advice, Said& said) {
  for (const Text text : advice.texts()) ++said[text];
}

Said told_of_salsa(const SceneCamera& camera) {
  CameraAdvice advice;
  advice.note(running_status());
  Said said;
  const CaptureScene scene = salsa_scene(10.0, SceneErrors{}, camera);
  MonoTime now = MonoTime::from_us(1'000'000);
  for (const SceneFrame& frame : scene.frames) {
    CameraFacts facts = good_facts();
    facts.body = seen_body(frame.landmarks, {camera.pinhole.width_px, camera.pinhole.height_px});
    now += Duration::ms(33);
    advice.see(facts, now);
    count(advice, said);
  }
  return said;
}

SceneCamera camera_at(double distance_m, double pitch_rad) {
  SceneCamera camera;
  camera.distance_m = distance_m;
  camera.pitch_rad = pitch_rad;
  return camera;
}

TEST(SeenDancer, SalsaBeforeAGoodCameraIsSeenFromHeadToFeetAllTheTime) {
  Said said = told_of_salsa(camera_at(3.6, 0.09));
  EXPECT_GE(said[Text::kCameraSeenWhole], 280);
  EXPECT_EQ(said.count(Text::kCameraFeetCutOff) + said.count(Text::kCameraHeadCutOff), 0u);
}

TEST(SeenDancer, ACameraThatLooksUpMissesTheFeetAndOneThatLooksDownTheHead) {
  Said up = told_of_salsa(camera_at(3.0, -0.25));
  EXPECT_GE(up[Text::kCameraFeetCutOff], 250);
  EXPECT_EQ(up.count(Text::kCameraHeadCutOff), 0u);
  Said down = told_of_salsa(camera_at(3.0, 0.4));
  EXPECT_GE(down[Text::kCameraHeadCutOff], 250);
  EXPECT_EQ(down.count(Text::kCameraFeetCutOff), 0u);
}

TEST(SeenDancer, NearAndFarAreToldSo) {
  Said near = told_of_salsa(camera_at(1.5, 0.09));
  EXPECT_GE(near[Text::kCameraStepBack], 200);
  EXPECT_EQ(near.count(Text::kCameraSeenWhole), 0u);
  Said far = told_of_salsa(camera_at(9.0, 0.05));
  EXPECT_GE(far[Text::kCameraComeCloser], 250);
}

// The filmed person, after `change` made something of the picture.
class FilmedDancer : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_POSE_MODELS();
    SKIP_WITHOUT_VIDEO();
    EstimatorOptions options;
    options.model = PoseNetworkModel::kFull;
    auto opened = PoseEstimator::open(options);
    ASSERT_TRUE(opened) << opened.error().what;
    estimator_ = std::move(*opened);
  }

  // Every third picture of the first six seconds: eight a second.
  template <class Change>
  Said told(Change change) {
    VideoPictures video(taiji_video());
    CameraAdvice advice;
    advice.note(running_status());
    ViewShake shake;
    Said said;
    cv::Mat film;
    for (int i = 0; i < 144 && video.next(film); ++i) {
      if (i % 3 != 0) continue;
      Frame frame;
      frame.image = change(film).clone();
      frame.capture_time = MonoTime::from_us(1'000'000 + i * 41'708);
      const BodyLandmarks& body = estimator_->estimate(frame);
      CameraFacts facts = good_facts();
      facts.time = frame.capture_time;
      facts.body = seen_body(body, frame.image.size());
      cv::Mat small;
      cv::Mat luma;
      cv::resize(frame.image, small, {320, 320 * frame.image.rows / frame.image.cols}, 0, 0,
                 cv::INTER_AREA);
      cv::cvtColor(small, luma, cv::COLOR_BGR2GRAY);
      facts.light = light_of(luma, facts.body);
      facts.shake = shake.see(luma, facts.body, facts.time);
      advice.see(facts, frame.capture_time);
      count(advice, said);
      line_ = std::string(dancer_advice_.see(frame.image, body));
      if (!line_.empty()) lines_ += line_ + "\n";
    }
    return said;
  }
  bool printed(const std::string& words) const { return lines_.find(words) != std::string::npos; }

  std::unique_ptr<PoseEstimator> estimator_;
  DancerAdvice dancer_advice_;  // the lines of `dance capture`
  std::string line_, lines_;
};

TEST_F(FilmedDancer, IsSeenFromHeadToFeet) {
  Said said = told([](const cv::Mat& film) { return film; });
  EXPECT_GE(said[Text::kCameraSeenWhole], 44);
  EXPECT_TRUE(printed("seen from head to feet")) << lines_;
}

TEST_F(FilmedDancer, WithoutAHeadIsNotSeenWholeThoughTheNetworkIsSure) {
  Said said = told([](const cv::Mat& film) { return film.rowRange(160, 720); });
  EXPECT_GE(said[Text::kCameraHeadCutOff], 30);
  EXPECT_EQ(said.count(Text::kCameraSeenWhole), 0u);
  EXPECT_TRUE(printed("the head is not in the picture")) << lines_;
  EXPECT_FALSE(printed("seen from head to feet")) << lines_;
}

TEST_F(FilmedDancer, WithoutFeetIsToldSo) {
  Said said = told([](const cv::Mat& film) { return film.rowRange(0, 560); });
  EXPECT_GE(said[Text::kCameraFeetCutOff], 30);
  EXPECT_EQ(said.count(Text::kCameraSeenWhole), 0u);
  EXPECT_TRUE(printed("the feet are not in the picture")) << lines_;
}

// As a car or a table does.
TEST_F(FilmedDancer, BehindSomethingThatHidesTheLegsIsToldSo) {
  Said said = told([](const cv::Mat& film) {
    cv::Mat picture = film.clone();
    cv::rectangle(picture, {300, 430, 700, 290}, cv::Scalar(80, 72, 64), cv::FILLED);
    return picture;
  });
  EXPECT_GE(said[Text::kCameraLegsHidden], 25);
  EXPECT_EQ(said.count(Text::kCameraSeenWhole), 0u);
  EXPECT_TRUE(printed("something hides the legs")) << lines_;
  EXPECT_FALSE(printed("seen from head to feet")) << lines_;
}

TEST_F(FilmedDancer, InTheDarkIsToldSo) {
  Said said = told([](const cv::Mat& film) { return cv::Mat(film * 0.25); });
  EXPECT_GE(said[Text::kCameraTooDark], 35);
}

TEST_F(FilmedDancer, BeforeACameraThatIsMovedIsToldSo) {
  int i = 0;
  Said said = told([&i](const cv::Mat& film) {
    const double angle = 0.5 * i++;
    const cv::Rect seen(40 + static_cast<int>(30 * std::sin(angle)),
                        20 + static_cast<int>(15 * std::cos(angle)), 1200, 680);
    return film(seen);
  });
  EXPECT_GE(said[Text::kCameraShakes], 20);
}

}  // namespace
}  // namespace dance
