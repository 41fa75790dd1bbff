#include "transformers/predict/model/predict_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_folder.h"

namespace dance {
namespace {

std::vector<std::uint8_t> built_in_file() {
  return bytes_in(DANCE_SOURCE_DIR "/data/predict/dance.model");
}

TEST(PredictModel, TheBuiltInOneIsTheFileOfTheTree) {
  const auto model = read_predict_model(built_in_file());
  ASSERT_TRUE(model);
  EXPECT_EQ((*model)->name, built_in_predict_model()->name);
  EXPECT_FALSE((*model)->dancers.empty());
}

TEST(PredictModel, WrittenAndReadAgainIsNearlyTheSame) {
  const auto model = built_in_predict_model();
  const auto again = read_predict_model(write_predict_model(*model));
  ASSERT_TRUE(again);
  EXPECT_EQ((*again)->weights, model->weights);
  EXPECT_EQ((*again)->lever, model->lever);
  for (std::size_t i = 0; i < model->net.first.size(); ++i)
    ASSERT_NEAR((*again)->net.first[i], model->net.first[i], 1e-3f);
}

TEST(PredictModel, KnowsTheDancersItWasTrainedOnAndNoOthers) {
  PredictModel model;
  Skeleton dancer = average_skeleton(1.7f);
  model.dancers.push_back(bone_lengths(dancer));
  EXPECT_TRUE(model.knows(dancer));
  dancer.offset_m[9].x() += 0.002f;
  EXPECT_TRUE(model.knows(dancer));
  EXPECT_FALSE(model.knows(average_skeleton(1.8f)));
}

TEST(PredictModel, WhatIsCutOffIsRefused) {
  const auto file = built_in_file();
  const std::span<const std::uint8_t> bytes(file);
  for (std::size_t n = 0; n < file.size(); n += n < 64 ? 1 : 4999)
    EXPECT_FALSE(read_predict_model(bytes.first(n))) << n;
  auto longer = file;
  longer.push_back(0);
  EXPECT_FALSE(read_predict_model(longer));
}

TEST(PredictModel, EveryFlippedBitIsRefusedOrGivesFiniteNumbers) {
  auto file = built_in_file();
  for (std::size_t n = 0; n < file.size(); n += n < 8000 ? 97 : 30011)
    for (int bit = 0; bit < 8; ++bit) {
      file[n] = static_cast<std::uint8_t>(file[n] ^ 1u << bit);
      if (const auto model = read_predict_model(file)) {
        BodyNet::visit((*model)->net, [](const BodyNet::Numbers& block) {
          for (std::size_t i = 0; i < block.size(); i += 101) ASSERT_TRUE(std::isfinite(block[i]));
        });
      }
      file[n] = static_cast<std::uint8_t>(file[n] ^ 1u << bit);
    }
}

TEST(PredictModel, SaysWhatIsWrong) {
  const std::vector<std::uint8_t> other(100, 7);
  const auto model = read_predict_model(other);
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().what.find("dance predict train"), std::string::npos);
}

}  // namespace
}  // namespace dance
