// Prediction's model is trained, on few seconds of two synthetic dancers: whether it learns at all,
// and always the same. What it learns from people is said by docs/prediction.md.
#include "research/predict/predict_training.h"

#include <gtest/gtest.h>

#include "producers/salsa/salsa_dancer.h"
#include "research/predict/predict_eval.h"

namespace dance {
namespace {

PredictTake take_of(SalsaRole role, double start_beat, std::size_t frames) {
  SalsaStyle style;
  style.role = role;
  style.start_beat = start_beat;
  SalsaDancer dancer(style);
  PredictTake take{"synthetic", dancer.skeleton(), 60.0, std::vector<Pose>(frames)};
  for (std::size_t i = 0; i < frames; ++i) {
    const Duration at = Duration::ns(16'666'667 * static_cast<std::int64_t>(i));
    dancer.dance_at(at, take.poses[i]);
    take.poses[i].clock_id = 1;
    take.poses[i].capture_time = MonoTime::from_us(1'000'000) + at;
  }
  return take;
}

PredictTraining small_training() {
  PredictTraining training;
  training.epochs = 3;
  training.folds = 2;
  for (const double start_beat : {0.0, 64.0})
    for (const SalsaRole role : {SalsaRole::kLead, SalsaRole::kFollow})
      training.takes.push_back(take_of(role, start_beat, kLeastTakeFrames));
  return training;
}

TEST(PredictTraining, LearnsADanceAndAlwaysTheSame) {
  PredictTraining training = small_training();
  std::vector<double> errors;  // of the network that sees all takes, round by round
  training.tell = [&](const std::string& line) {
    const std::size_t error = line.find("error ");
    if (line.starts_with("all takes") && error != std::string::npos)
      errors.push_back(std::stod(line.substr(error + 6)));
  };
  const auto model = train_predict(training);
  ASSERT_TRUE(model) << model.error().what;
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_LT(errors[2], 0.9 * errors[0]);
  EXPECT_EQ(model->dancers.size(), 2u);
  const auto bytes = write_predict_model(*model);
#ifndef DANCE_SANITIZED  // a second training runs the same code, for a minute there
  training.tell = {};
  EXPECT_EQ(bytes, write_predict_model(*train_predict(training)));
#endif

  PredictEvalOptions options;
  const auto read = read_predict_model(bytes);
  ASSERT_TRUE(read);
  options.model = *read;
  options.horizons = {Duration::ms(100), Duration::ms(200)};
  const PredictEval eval = evaluate_prediction({take_of(SalsaRole::kLead, 320.0, 900)}, options);
  EXPECT_EQ(eval.known_dancers, 1u);
  for (const ForecastErrors& e : eval.mean_m) EXPECT_LT(e[0], 0.6 * std::min({e[1], e[2], e[3]}));
}

TEST(PredictTraining, SaysWhatIsMissing) {
  PredictTraining training = small_training();
  training.takes.resize(3);
  const auto few = train_predict(training);
  ASSERT_FALSE(few);
  EXPECT_NE(few.error().what.find("4 takes"), std::string::npos) << few.error().what;
  training = small_training();
  for (PredictTake& take : training.takes) take.skeleton = training.takes[0].skeleton;
  EXPECT_FALSE(train_predict(training)) << "one dancer";

  training = small_training();
  for (std::size_t i = 0; i < training.takes.size(); ++i)
    for (auto& offset : training.takes[i].skeleton.offset_m)
      offset *= 1.0f + 0.1f * static_cast<float>(i);
  const auto single = train_predict(training);
  ASSERT_FALSE(single) << "each dancer once";
  EXPECT_NE(single.error().what.find("two takes of one dancer"), std::string::npos);

  training = small_training();
  training.takes[1].poses.resize(100);
  const auto brief = train_predict(training);
  ASSERT_FALSE(brief);
  EXPECT_NE(brief.error().what.find("synthetic has 100 frames"), std::string::npos);
}

}  // namespace
}  // namespace dance
