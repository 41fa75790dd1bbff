#include "producers/music/tracker/net/rhythm_net.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "producers/music/tracker/beat_model.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

using Features = std::array<float, RhythmFeatures::kCount>;

Features noise(Random& random, double size) {
  Features features;
  for (float& x : features) x = static_cast<float>(size * random.uniform(-1.0, 1.0));
  return features;
}

TEST(RhythmNet, AUnitRemembersWhatItWasTold) {
  // The first unit takes the first feature where the second one opens it, and keeps it.
  RhythmNet net;
  RecurrentLayer& first = net.layers[0];
  first.in(2 * RhythmNet::kUnits, 0) = 8.0f;  // what is new
  first.in_bias[0] = 20.0f;                   // kept
  first.in(0, 1) = -40.0f;                    // but where the second feature is 1
  // The second layer hands it on, the answer shows it.
  net.layers[1].in(2 * RhythmNet::kUnits, 0) = 8.0f;
  net.layers[1].in_bias[0] = -20.0f;
  net.out(0, 0) = 3.0f;
  RhythmState state;
  const auto told = [&](float value, float open) {
    Features features{};
    features[0] = value;
    features[1] = open;
    return net.step(features, state).beat;
  };
  EXPECT_EQ(told(1.0f, 0.0f), 0.0f) << "it is closed";
  EXPECT_NEAR(told(1.0f, 1.0f), 3.0f, 1e-3f);
  for (int i = 0; i < 500; ++i) EXPECT_NEAR(told(0.0f, 0.0f), 3.0f, 1e-2f) << i;
  EXPECT_NEAR(told(-1.0f, 1.0f), -3.0f, 1e-3f);
}

TEST(RhythmNet, IsBoundedWhateverComesIn) {
  const auto model = built_in_beat_model();
  Random random(3);
  RhythmState state;
  for (int i = 0; i < 300; ++i) {
    const StrokeMeaning meaning = model->net.step(noise(random, i < 150 ? 3.0 : 1e6), state);
    ASSERT_LE(std::abs(meaning.beat), 5.0f);
    ASSERT_LE(std::abs(meaning.half), 5.0f);
    for (const Eigen::VectorXf& units : state.units) ASSERT_LE(units.cwiseAbs().maxCoeff(), 1.0f);
    ASSERT_NEAR(state.tempi.array().exp().sum(), 1.0f, 1e-3f) << "they are probabilities";
  }
}

TEST(RhythmNet, AllocatesNothing) {
  const auto model = built_in_beat_model();
  RhythmState state;
  const Features features{};
  const AllocationGuard guard;
  for (int i = 0; i < 50; ++i) model->net.step(features, state);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(RhythmNet, PlacesOfTempiAreEvenInTheirLogarithm) {
  EXPECT_NEAR(RhythmNet::place_of_tempo(RhythmNet::kSlowest_bpm), 0.0, 1e-9);
  EXPECT_NEAR(RhythmNet::place_of_tempo(RhythmNet::kFastest_bpm), RhythmNet::kTempi - 1.0, 1e-9);
  EXPECT_NEAR(RhythmNet::place_of_tempo(200.0) - RhythmNet::place_of_tempo(100.0),
              RhythmNet::place_of_tempo(150.0) - RhythmNet::place_of_tempo(75.0), 1e-9);
}

}  // namespace
}  // namespace dance
