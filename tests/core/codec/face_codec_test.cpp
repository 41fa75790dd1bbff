#include "core/codec/face_codec.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/random.h"

namespace dance {
namespace {

// So many expressions are shown, both sides nearly alike.
Face face_of(Random& random, double shown) {
  Face face;
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    const bool is_right = i > 0 && std::string_view(kExpressionNames[i]).ends_with("Right") &&
                          std::string_view(kExpressionNames[i - 1]).ends_with("Left");
    if (is_right && random.uniform(0.0, 1.0) < 0.9) {
      const auto noise = static_cast<float>(random.uniform(-0.05, 0.05));
      face.weight[i] =
          face.weight[i - 1] > 0.0f ? std::clamp(face.weight[i - 1] + noise, 0.0f, 1.0f) : 0.0f;
    } else if (random.uniform(0.0, 1.0) < shown) {
      face.weight[i] = static_cast<float>(random.uniform(0.0, 1.0));
    }
  }
  const auto angle = [&] { return static_cast<float>(random.uniform(-0.6, 0.6)); };
  face.R_PB = Eigen::AngleAxisf(angle(), Eigen::Vector3f::UnitY()) *
              Eigen::AngleAxisf(angle(), Eigen::Vector3f::UnitX());
  face.presence = kFaceSeen | kGazeSeen;
  face.gaze_rad = {angle(), angle()};
  return face;
}

TEST(FaceCodec, ComesBackWithinHalfAStep) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Face face = face_of(random, 0.05 * (i % 20));
    std::array<std::uint8_t, kMaxFacePayload> payload;
    const std::size_t size = encode_face(face, payload);
    ASSERT_GT(size, 0u);
    Face back;
    ASSERT_TRUE(decode_face({payload.data(), size}, back));
    for (std::size_t k = 0; k < kExpressionCount; ++k)
      EXPECT_NEAR(back.weight[k], face.weight[k], kFaceWeightError + 1e-5f);
    EXPECT_LT(57.3f * back.R_PB.angularDistance(face.R_PB), kFaceHeadError_deg);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_LT(57.3f * std::abs(back.gaze_rad[k] - face.gaze_rad[k]), kFaceGazeError_deg);
    EXPECT_EQ(back.presence, face.presence);
    // What was decoded is coded again to the same bytes.
    std::array<std::uint8_t, kMaxFacePayload> again;
    ASSERT_EQ(encode_face(back, again), size);
    EXPECT_TRUE(std::equal(again.begin(), again.begin() + static_cast<std::ptrdiff_t>(size),
                           payload.begin()));
  }
}

TEST(FaceCodec, IsADozenBytesAndFewAtRest) {
  Random random(4);
  std::array<std::uint8_t, kMaxFacePayload> payload;
  std::size_t bytes = 0;
  constexpr int kFaces = 300;
  for (int i = 0; i < kFaces; ++i) bytes += encode_face(face_of(random, 0.2), payload);
  EXPECT_LT(static_cast<double>(bytes) / kFaces, 18.0);
  Face rest;
  rest.presence = kFaceSeen;
  EXPECT_LE(encode_face(rest, payload), 6u);
}

TEST(FaceCodec, TheWorstFaceFits) {
  Face face;
  face.presence = kFaceSeen | kGazeSeen;
  for (std::size_t i = 0; i < kExpressionCount; ++i) face.weight[i] = i % 2 == 0 ? 1.0f : 0.04f;
  std::array<std::uint8_t, kMaxFacePayload> payload;
  EXPECT_GT(encode_face(face, payload), 0u);
  EXPECT_EQ(encode_face(face, std::span(payload).first(4)), 0u);
  face.weight[0] = 1.5f;
  EXPECT_EQ(encode_face(face, payload), 0u);
}

TEST(FaceCodec, DamagedBytesAreRefusedOrAFace) {
  Random random(5);
  std::array<std::uint8_t, kMaxFacePayload> payload;
  const std::size_t size = encode_face(face_of(random, 0.3), payload);
  Face face;
  for (std::size_t cut = 0; cut < size; ++cut)
    if (decode_face({payload.data(), cut}, face)) {
      EXPECT_TRUE(is_valid(face));
    }
  for (std::size_t bit = 0; bit < 8 * size; ++bit) {
    auto damaged = payload;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1u << (bit % 8)));
    if (decode_face({damaged.data(), size}, face)) {
      EXPECT_TRUE(is_valid(face));
    }
  }
  EXPECT_FALSE(decode_face({}, face));
  EXPECT_FALSE(decode_face(std::vector<std::uint8_t>(200), face));
}

}  // namespace
}  // namespace dance
