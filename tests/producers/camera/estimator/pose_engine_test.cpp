#include "producers/camera/estimator/pose_engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "producers/camera/estimator/tflite_file.h"
#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/estimator/tiny_network.h"

namespace dance {
namespace {

std::vector<EngineKind> engines_here() {
  std::vector<EngineKind> engines{EngineKind::kOpenCv};
  if (kHasXnnpack) engines.push_back(EngineKind::kXnnpack);
  return engines;
}

std::vector<float> random_input(std::size_t count, double least) {
  Random random(7);
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(random.uniform(least, 1.0));
  return values;
}

void feed(PoseEngine& engine, const std::vector<float>& input) {
  ASSERT_EQ(engine.input().size(), input.size());
  std::copy(input.begin(), input.end(), engine.input().begin());
  ASSERT_TRUE(engine.run());
}

void expect_as_plain_loops(const std::vector<std::uint8_t>& file) {
  auto graph = parse_tflite(file);
  ASSERT_TRUE(graph) << graph.error().what;
  const std::vector<float> input = random_input(8 * 8 * 4, -1.0);
  const auto due = computed_plainly(*graph, input);
  fold_pads(*graph);
  const auto due_folded = computed_plainly(*graph, input);
  for (const EngineKind kind : engines_here()) {
    auto engine = make_engine(kind, *graph);
    ASSERT_TRUE(engine) << engine.error().what;
    for (int again = 0; again < 2; ++again) {
      feed(**engine, input);
      for (std::size_t o = 0; o < due.size(); ++o) {
        const auto got = (*engine)->output(o);
        ASSERT_EQ(got.size(), due[o].size()) << name_of(kind);
        for (std::size_t i = 0; i < got.size(); ++i) {
          EXPECT_NEAR(got[i], due[o][i], 2e-5) << name_of(kind) << " output " << o << " at " << i;
          EXPECT_EQ(due[o][i], due_folded[o][i]);
        }
      }
    }
  }
}

TEST(PoseEngine, ComputesWhatPlainLoopsCompute) { expect_as_plain_loops(tiny_network_file()); }
TEST(PoseEngine, ComputesWhatHandsAndFaceHaveBesideThat) {
  expect_as_plain_loops(tiny_hand_network_file());
}

TEST(PoseEngine, LeavesOutWhatNobodyNeeds) {
  auto graph = parse_tflite(tiny_network_file());
  ASSERT_TRUE(graph);
  const std::size_t nodes = graph->nodes.size();
  keep_outputs(*graph, {graph->outputs[1]});
  fold_pads(*graph);
  // The convolution, the depthwise one, their sum, the pooling and the larger picture.
  EXPECT_EQ(graph->nodes.size(), 5u);
  EXPECT_GT(nodes, 10u);
  const std::vector<float> input = random_input(8 * 8 * 4, -1.0);
  const auto due = computed_plainly(*graph, input);
  for (const EngineKind kind : engines_here()) {
    auto engine = make_engine(kind, *graph);
    ASSERT_TRUE(engine) << engine.error().what;
    feed(**engine, input);
    for (std::size_t i = 0; i < due[0].size(); ++i)
      EXPECT_NEAR((*engine)->output(0)[i], due[0][i], 2e-5) << name_of(kind);
  }
}

TEST(PoseEngine, AnEngineThatIsNotBuiltInIsAnErrorWithItsCure) {
  if (kHasXnnpack) GTEST_SKIP() << "XNNPACK is built in here";
  const auto graph = parse_tflite(tiny_convolution_file());
  const auto engine = make_engine(EngineKind::kXnnpack, *graph);
  ASSERT_FALSE(engine);
  EXPECT_NE(engine.error().what.find("libxnnpack-dev"), std::string::npos);
}

// The same numbers in, the same numbers out, up to rounding.
TEST(PoseEngine, BothAgreeOnTheRealNetworks) {
  SKIP_WITHOUT_POSE_MODELS();
  if (!kHasXnnpack) GTEST_SKIP() << "only one engine is built in";
  const std::string folder = pose_models_folder("");
  const std::pair<Result<PoseGraph>, double> cases[] = {
      {read_detector(folder), -1.0}, {read_landmark_model(folder, PoseNetworkModel::kFull), 0.0}};
  for (const auto& [read, least] : cases) {
    ASSERT_TRUE(read) << read.error().what;
    PoseGraph graph = *read;
    fold_pads(graph);
    auto one = make_engine(EngineKind::kXnnpack, graph);
    auto two = make_engine(EngineKind::kOpenCv, graph);
    ASSERT_TRUE(one) << one.error().what;
    ASSERT_TRUE(two) << two.error().what;
    const std::vector<float> input = random_input((*one)->input().size(), least);
    feed(**one, input);
    feed(**two, input);
    for (std::size_t o = 0; o < graph.outputs.size(); ++o) {
      const auto a = (*one)->output(o), b = (*two)->output(o);
      ASSERT_EQ(a.size(), b.size());
      float largest = 1.0f;
      for (const float value : a) largest = std::max(largest, std::abs(value));
      for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(a[i], b[i], 2e-4f * largest) << "output " << o << " at " << i;
    }
  }
}

}  // namespace
}  // namespace dance
