#include "producers/camera/estimator/tflite_file.h"

#include <gtest/gtest.h>

#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/estimator/tiny_network.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

TEST(TfliteFile, ReadsHalvesSparseWeightsAndPadding) {
  const auto graph = parse_tflite(tiny_network_file());
  ASSERT_TRUE(graph) << graph.error().what;
  EXPECT_EQ(graph->shape(graph->input), (Shape{1, 8, 8, 4}));
  ASSERT_EQ(graph->outputs.size(), 2u);
  EXPECT_EQ(graph->shape(graph->outputs[0]), (Shape{1, 24}));
  EXPECT_EQ(graph->shape(graph->outputs[1]), (Shape{1, 4, 4, 6}));
  const GraphNode& first = graph->nodes[0];
  ASSERT_EQ(first.op, GraphOp::kConvolution);
  EXPECT_EQ(first.pad_top, 0);
  EXPECT_EQ(first.pad_bottom, 1);
  EXPECT_EQ(first.most, 6.0f);
  const GraphNode& second = graph->nodes[1];
  ASSERT_EQ(second.op, GraphOp::kDepthwise);
  const std::vector<float>& weights = graph->values(second.weights);
  ASSERT_EQ(weights.size(), 150u);
  for (std::size_t i = 0; i < weights.size(); ++i)
    EXPECT_EQ(weights[i] == 0.0f, i % 6 >= 3) << "weight " << i;
}

TEST(TfliteFile, UnpacksHalfPrecisionExactly) {
  TinyFile file;
  const int in = file.computed({1, 1, 1, 1}), out = file.computed({1, 1, 1, 4});
  file.add(3,
           {in, file.halves({4, 1, 1, 1}, {0x3c00, 0xc000, 0x0001, 0x7bff}),
            file.floats({4}, {0, 0, 0, 0})},
           out, file.convolution(1, 1, 0));
  const auto graph = parse_tflite(file.file(in, {out}));
  ASSERT_TRUE(graph) << graph.error().what;
  EXPECT_EQ(graph->values(graph->nodes[0].weights),
            (std::vector<float>{1.0f, -2.0f, 5.9604644775390625e-8f, 65504.0f}));
}

TEST(TfliteFile, EveryPrefixIsAnErrorThatSaysWhat) {
  const std::vector<std::uint8_t> whole = tiny_network_file();
  for (std::size_t size = 0; size + 4 < whole.size(); ++size) {
    const auto graph = parse_tflite(std::span(whole).first(size));
    ASSERT_FALSE(graph) << "of " << whole.size() << " bytes " << size << " were enough";
    EXPECT_FALSE(graph.error().what.empty());
  }
}

TEST(TfliteFile, RefusesOptionsOfAnotherKind) {
  TinyFile file;
  const int in = file.computed({1, 1, 1, 1}), out = file.computed({1, 1, 1, 1});
  file.add(0, {in, in}, out, file.convolution(0, 1, 0));
  const auto graph = parse_tflite(file.file(in, {out}));
  ASSERT_FALSE(graph);
  EXPECT_EQ(graph.error().what, "operator 0: it has no options of its kind");
}

TEST(TfliteFile, SaysWhatItDoesNotKnow) {
  TinyFile file;
  const int in = file.computed({1, 1, 1, 1}), out = file.computed({1, 1, 1, 1});
  file.add(99, {in}, out);
  const auto graph = parse_tflite(file.file(in, {out}));
  ASSERT_FALSE(graph);
  EXPECT_EQ(graph.error().what, "operator 0: operation 99 is not known here");
}

TEST(TfliteFile, RefusesWeightsThatDoNotFit) {
  TinyFile file;
  const int in = file.computed({1, 1, 1, 2}), out = file.computed({1, 1, 1, 1});
  file.add(3, {in, file.floats({1, 1, 1, 2}, {1.0f}), file.floats({1}, {0.0f})}, out,
           file.convolution(1, 1, 0));
  const auto graph = parse_tflite(file.file(in, {out}));
  ASSERT_FALSE(graph);
  EXPECT_NE(graph.error().what.find("has 4 bytes, where 8 are due"), std::string::npos)
      << graph.error().what;
}

TEST(TfliteFile, RefusesWhatIsNoNumber) {
  TinyFile file;
  const int in = file.computed({1, 1, 1, 1}), out = file.computed({1, 1, 1, 1});
  file.add(3, {in, file.halves({1, 1, 1, 1}, {0x7e00}), file.floats({1}, {0.0f})}, out,
           file.convolution(1, 1, 0));
  const auto graph = parse_tflite(file.file(in, {out}));
  ASSERT_FALSE(graph);
  EXPECT_NE(graph.error().what.find("no finite number"), std::string::npos) << graph.error().what;
}

TEST(TfliteFile, RefusesAShapeThatDoesNotFollow) {
  TinyFile file;
  const int in = file.computed({1, 4, 4, 1}), out = file.computed({1, 4, 3, 1});
  file.add(14, {in}, out);
  const auto graph = parse_tflite(file.file(in, {out}));
  ASSERT_FALSE(graph);
  EXPECT_NE(graph.error().what.find("not of the shape"), std::string::npos) << graph.error().what;
}

TEST(TfliteFile, AMissingFileIsNamedWithItsCure) {
  const auto graph = read_tflite_file("/nowhere/pose_detection.tflite");
  ASSERT_FALSE(graph);
  EXPECT_EQ(graph.error().what,
            "/nowhere/pose_detection.tflite: no such file; `dance fetch-models` fetches it");
}

TEST(TfliteFile, ReadsTheRealNetworks) {
  SKIP_WITHOUT_POSE_MODELS();
  const auto people = read_detector(pose_models_folder(""));
  ASSERT_TRUE(people) << people.error().what;
  EXPECT_EQ(people->shape(people->input), (Shape{1, 224, 224, 3}));
  const auto points = read_landmark_model(pose_models_folder(""), PoseNetworkModel::kFull);
  ASSERT_TRUE(points) << points.error().what;
  EXPECT_EQ(points->outputs.size(), 5u);
}

TEST(TfliteFile, ADamagedNetworkIsAnErrorOrAWholeGraph) {
  SKIP_WITHOUT_POSE_MODELS();
  std::vector<std::uint8_t> bytes = bytes_in(pose_models_folder("") + "/pose_detection.tflite");
  ASSERT_GT(bytes.size(), 1000u);
  EXPECT_FALSE(parse_tflite(std::span(bytes).first(bytes.size() / 2)));
  std::size_t refused = 0;
  const std::size_t step = bytes.size() / 23;
  // Tables stand at the end, weights before them: both are hit.
  for (std::size_t at = 3; at < bytes.size(); at += step) {
    const std::uint8_t was = bytes[at];
    bytes[at] = static_cast<std::uint8_t>(~was);
    refused += parse_tflite(bytes) ? 0 : 1;
    bytes[at] = was;
  }
  for (std::size_t i = 0; i < 60; ++i) {
    const std::size_t at = bytes.size() - 1 - i * 337;
    const std::uint8_t was = bytes[at];
    bytes[at] = 0xff;
    refused += parse_tflite(bytes) ? 0 : 1;
    bytes[at] = was;
  }
  EXPECT_GT(refused, 3u);
  EXPECT_TRUE(parse_tflite(bytes));
}

}  // namespace
}  // namespace dance
