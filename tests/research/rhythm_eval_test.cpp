#include "research/rhythm/rhythm_eval.h"

#include <gtest/gtest.h>

#include <cmath>

#include "research/predict_model_file.h"
#include "testing/motion/beat_phase.h"
#include "testing/motion/take_grid.h"

namespace dance {
namespace {

BeatGrid steady_music(double tempo_bpm) {
  std::vector<GridBeat> beats;
  for (int i = 0; i < 400; ++i) beats.push_back({0.1 + i * 60.0 / tempo_bpm, 1 + i % 4});
  return *BeatGrid::make(beats);
}

BeatDance salsa(const BeatGrid& music, double tempo_bpm = 0.0) {
  return salsa_to_music(SalsaRole::kFollow, 3, tempo_bpm, Duration::s(24), music, 60.0);
}

TEST(BeatPhase, TellsByHowMuchADanceIsLate) {
  const BeatGrid music = steady_music(160.0);
  const BeatDance dance = salsa(music);
  const JointTrack track(dance.skeleton, dance.poses, 60.0);
  for (const double late_beats : {0.0, 0.1, -0.2, 0.45, 2.3}) {
    DanceOnBeats shown{&track, dance.beats};
    for (double& beats : shown.beats) beats += late_beats;
    const std::vector<double> offsets(shown.beats.size(), std::round(late_beats));
    const BeatPhase phase =
        beat_phase(shown, {&track, dance.beats}, offsets, 200, shown.beats.size() - 200);
    EXPECT_GT(phase.told, 0.9) << late_beats;
    EXPECT_NEAR(phase.mean_beats, late_beats - std::round(late_beats), 0.03) << late_beats;
    EXPECT_LT(phase.sd_beats, 0.05) << late_beats;
  }
}

TEST(BeatPhase, SeesADriftAsSpread) {
  const BeatGrid music = steady_music(160.0);
  const BeatDance dance = salsa(music);
  const JointTrack track(dance.skeleton, dance.poses, 60.0);
  DanceOnBeats shown{&track, dance.beats};
  for (std::size_t i = 0; i < shown.beats.size(); ++i)
    shown.beats[i] += 0.4 * static_cast<double>(i) / static_cast<double>(shown.beats.size()) - 0.2;
  const std::vector<double> none(shown.beats.size(), 0.0);
  const BeatPhase phase = beat_phase(shown, {&track, dance.beats}, none, 0, shown.beats.size());
  EXPECT_NEAR(phase.mean_beats, 0.0, 0.03);
  EXPECT_NEAR(phase.sd_beats, 0.4 / std::sqrt(12.0), 0.04);
}

TEST(BeatPhase, LeavesOutWhatDoesNotDance) {
  const BeatGrid music = steady_music(160.0);
  BeatDance dance = salsa(music);
  for (Pose& pose : dance.poses) pose.R_PB = dance.poses[0].R_PB;
  const JointTrack track(dance.skeleton, dance.poses, 60.0);
  const std::vector<double> none(dance.beats.size(), 0.0);
  const BeatPhase phase = beat_phase({&track, dance.beats}, {&track, dance.beats}, none, 0, 1000);
  EXPECT_EQ(phase.told, 0.0);
}

TEST(TakeGrid, FindsTheTempoOfTheFeet) {
  for (const double tempo : {120.0, 164.0, 190.0}) {
    const BeatDance dance = salsa(steady_music(tempo));
    const TakeGrid grid = find_take_grid(JointTrack(dance.skeleton, dance.poses, 60.0));
    EXPECT_NEAR(grid.tempo_bpm, tempo, 0.02 * tempo);
    EXPECT_GT(grid.strength, 0.05);
  }
}

TEST(RhythmEval, LaysATakeOntoTheBeatsOfASong) {
  const BeatDance dance = salsa(steady_music(164.0));
  CodecTake take;
  take.name = "take";
  take.skeleton = dance.skeleton;
  take.hz = 60.0;
  take.poses = dance.poses;
  const BeatGrid music = steady_music(150.0);
  const BeatDance laid = lay_onto_beats(take, music, 60.0);
  EXPECT_EQ(laid.name, "take");
  // As many beats as the take has, at the song's tempo.
  EXPECT_NEAR(static_cast<double>(laid.poses.size()), 24.0 * 60.0 * 164.0 / 150.0, 60.0);
  const TakeGrid grid = find_take_grid(JointTrack(laid.skeleton, laid.poses, 60.0));
  EXPECT_NEAR(grid.tempo_bpm, 150.0, 3.0);
  for (std::size_t i = 1; i < laid.poses.size(); ++i)
    ASSERT_GT(laid.poses[i].music_beats, laid.poses[i - 1].music_beats);
}

TEST(RhythmEval, TellsTheDelayOfALineAndFindsRhythmBetterThanHold) {
  const BeatGrid music = steady_music(160.0);
  const std::vector<BeatDance> dances{salsa(music)};
  RhythmEvalOptions options;
  options.delay = Duration::ms(120);
  options.tempo_offset_percent = 1.0;
  const auto raw = evaluate_rhythm(dances, music, {"raw", {}}, options);
  const auto hold = evaluate_rhythm(dances, music, {"hold", {"hold 40ms"}}, options);
  const auto ours = evaluate_rhythm(dances, music, {"rhythm", {"rhythm beats=2"}}, options);
  ASSERT_TRUE(raw && hold && ours);
  // On average a pose is as old as its way and half a frame, at most a whole one.
  EXPECT_NEAR(raw->mean.content_delay_ms, 128.0, 9.0);
  EXPECT_NEAR(hold->mean.content_delay_ms, 160.0, 5.0);
  EXPECT_GT(hold->mean.phase_sd_ms, 20.0) << "the musics drift apart";
  EXPECT_LT(ours->mean.phase_sd_ms, 10.0);
  EXPECT_LT(std::abs(ours->mean.phase_mean_ms), 5.0);
  EXPECT_GT(ours->mean.least_rate, 0.99);
  EXPECT_LT(ours->mean.most_rate, 1.03);
  EXPECT_LT(ours->mean.bone_length_error_mm, 0.01);
  EXPECT_LT(ours->mean.foot_slide_ratio, 1.2);
}

TEST(RhythmEval, JudgesAnotherModelOfPrediction) {
  const BeatGrid music = steady_music(160.0);
  const std::vector<BeatDance> dances{salsa(music)};
  RhythmEvalOptions options;
  options.delay = Duration::ms(120);
  const auto with = [&](const FlowParts& parts) {
    return evaluate_rhythm(dances, music, {"predict", {"predict"}, parts}, options)->mean.mpjpe_mm;
  };
  // One that trusts no prediction at all repeats the newest pose. Legs that wait for a step are
  // behind either way.
  auto distrusts = std::make_shared<PredictModel>(*built_in_predict_model());
  distrusts->weights = {};
  EXPECT_LT(with({}), 0.95 * with({distrusts}));
  EXPECT_DOUBLE_EQ(with({}), with({built_in_predict_model()}));
}

TEST(PredictModelFile, IsReadOrNamedWithWhatIsWrong) {
  const std::string file = DANCE_SOURCE_DIR "/data/predict/dance.model";
  const auto model = read_predict_model_file(file);
  ASSERT_TRUE(model);
  EXPECT_EQ((*model)->name, built_in_predict_model()->name);
  EXPECT_EQ(parts_with_model(file)->predict_model->name, (*model)->name);
  EXPECT_EQ(parts_with_model("")->predict_model, nullptr);
  for (const char* wrong : {"/no/such.model", DANCE_SOURCE_DIR "/README.md"}) {
    const auto refused = parts_with_model(wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_NE(refused.error().what.find(wrong), std::string::npos) << refused.error().what;
  }
}

TEST(RhythmEval, RefusesAStationThatIsNot) {
  const BeatGrid music = steady_music(160.0);
  const auto run = evaluate_rhythm({salsa(music)}, music, {"x", {"rythm"}}, {});
  ASSERT_FALSE(run.has_value());
  EXPECT_NE(run.error().what.find("rythm"), std::string::npos);
}

}  // namespace
}  // namespace dance
