#include "producers/camera/face/face_solver.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/base/random.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

MonoTime picture_at(int picture) {
  return MonoTime{} + Duration::s(1) + Duration::ms(33 * picture);
}

// A face at rest before the camera: a plane with the points that features are made of, in pixels.
FaceLandmarks face_at_rest() {
  FaceLandmarks face;
  face.found = true;
  face.presence = 1.0f;
  for (auto& p : face.image_px) p = {0.0f, 0.0f, 0.0f};
  const auto pair = [&](std::size_t left, std::size_t right, float x, float y) {
    face.image_px[left] = {x, y, 0.0f};
    face.image_px[right] = {-x, y, 0.0f};
  };
  const auto middle = [&](std::size_t point, float y) { face.image_px[point] = {0.0f, y, 0.0f}; };
  pair(263, 33, 50.0f, 0.0f);    // outer corners of the eyes
  pair(362, 133, 18.0f, 0.0f);   // inner ones
  pair(386, 159, 34.0f, -5.0f);  // upper lids
  pair(374, 145, 34.0f, 5.0f);   // lower lids
  pair(285, 55, 15.0f, -20.0f);  // brows
  pair(300, 70, 52.0f, -22.0f);
  pair(291, 61, 26.0f, 58.0f);  // corners of the mouth
  pair(270, 40, 13.0f, 52.0f);  // lips beside the middle
  pair(321, 91, 13.0f, 66.0f);
  pair(358, 129, 18.0f, 35.0f);  // wings of the nose
  pair(330, 101, 38.0f, 30.0f);  // cheeks
  middle(10, -70.0f);
  middle(2, 40.0f);
  middle(152, 100.0f);
  middle(0, 51.0f);
  middle(13, 57.0f);
  middle(14, 58.0f);
  middle(17, 66.0f);
  return face;
}

FaceFeatures features_of(const FaceLandmarks& face) {
  const auto shape = shape_of(face);
  EXPECT_TRUE(shape);
  return shape ? shape->features : FaceFeatures{};
}

std::array<float, kExpressionCount> shown_by(const std::function<void(FaceLandmarks&)>& change) {
  FaceLandmarks face = face_at_rest();
  change(face);
  return expressions_of(features_of(face), features_of(face_at_rest()), 0.0f);
}

float of(const std::array<float, kExpressionCount>& weight, Expression e) {
  return weight[index_of(e)];
}

TEST(FaceSolver, AFaceAtRestShowsNothing) {
  for (const float weight : shown_by([](FaceLandmarks&) {})) EXPECT_EQ(weight, 0.0f);
}

TEST(FaceSolver, WhatWandersWithinTheNoiseOfASmallFaceShowsNothing) {
  FaceLandmarks face = face_at_rest();
  face.image_px[285].y() += 2.0f;  // a brow: a third of a frown of the large face
  const FaceFeatures rest = features_of(face_at_rest());
  const auto far = expressions_of(features_of(face), rest, 0.025f);
  EXPECT_EQ(of(far, Expression::kBrowDownLeft), 0.0f);
  const auto near = expressions_of(features_of(face), rest, 0.005f);
  EXPECT_GT(of(near, Expression::kBrowDownLeft), 0.1f);
}

TEST(FaceSolver, AClosedEyeBlinksOnItsOwnSide) {
  const auto left = shown_by([](FaceLandmarks& face) { face.image_px[386].y() = 4.5f; });
  EXPECT_GT(of(left, Expression::kEyeBlinkLeft), 0.9f);
  EXPECT_EQ(of(left, Expression::kEyeBlinkRight), 0.0f);
  EXPECT_EQ(of(left, Expression::kJawOpen), 0.0f);
  const auto wide = shown_by([](FaceLandmarks& face) { face.image_px[159].y() = -9.0f; });
  EXPECT_GT(of(wide, Expression::kEyeWideRight), 0.5f);
  EXPECT_EQ(of(wide, Expression::kEyeWideLeft), 0.0f);
}

TEST(FaceSolver, AnOpenJawIsNoFrownAndNoSmile) {
  const auto open = shown_by([](FaceLandmarks& face) {
    face.image_px[152].y() += 30.0f;
    for (const std::size_t i : {14u, 17u, 321u, 91u}) face.image_px[i].y() += 28.0f;
    for (const std::size_t i : {291u, 61u}) face.image_px[i].y() += 7.0f;
  });
  EXPECT_GT(of(open, Expression::kJawOpen), 0.7f);
  EXPECT_LT(of(open, Expression::kMouthFrownLeft), 0.15f);
  EXPECT_EQ(of(open, Expression::kMouthSmileLeft), 0.0f);
  EXPECT_LT(of(open, Expression::kMouthClose), 0.2f);
}

TEST(FaceSolver, ASmileLiftsTheCornersAndAPuckerNarrowsTheMouth) {
  const auto smile = shown_by([](FaceLandmarks& face) {
    for (const std::size_t i : {291u, 61u}) {
      face.image_px[i].x() *= 1.3f;
      face.image_px[i].y() -= 12.0f;
    }
  });
  EXPECT_GT(of(smile, Expression::kMouthSmileLeft), 0.7f);
  EXPECT_NEAR(of(smile, Expression::kMouthSmileLeft), of(smile, Expression::kMouthSmileRight),
              1e-4f);
  EXPECT_EQ(of(smile, Expression::kMouthPucker), 0.0f);
  const auto pucker = shown_by([](FaceLandmarks& face) {
    for (const std::size_t i : {291u, 61u}) face.image_px[i].x() *= 0.7f;
  });
  EXPECT_GT(of(pucker, Expression::kMouthPucker), 0.7f);
  EXPECT_EQ(of(pucker, Expression::kMouthSmileLeft), 0.0f);
}

TEST(FaceSolver, NeitherDistanceNorTurnOfTheHeadChangesAnExpression) {
  FaceLandmarks face = face_at_rest();
  face.image_px[386].y() = 2.0f;
  const FaceFeatures due = features_of(face);
  const Quaternionf R(Eigen::AngleAxisf(0.4f, Vector3f(0.3f, 0.9f, 0.2f).normalized()));
  for (auto& p : face.image_px) p = 0.4f * (R * p) + Vector3f(300.0f, 200.0f, -20.0f);
  const auto shape = shape_of(face);
  ASSERT_TRUE(shape);
  for (std::size_t f = 0; f < kFaceFeatureCount; ++f)
    EXPECT_NEAR(shape->features[f], due[f], 1e-4f) << f;
  const auto straight = shape_of(face_at_rest());
  EXPECT_LT((shape->R_CHead * straight->R_CHead.conjugate()).angularDistance(R), 1e-3f);
}

TEST(FaceSolver, WhateverThePointsAreWeightsStayWithinTheirRange) {
  Random random(11);
  const FaceFeatures rest = features_of(face_at_rest());
  for (int i = 0; i < 300; ++i) {
    FaceLandmarks face = face_at_rest();
    for (auto& p : face.image_px)
      for (int k = 0; k < 3; ++k) p[k] += static_cast<float>(random.uniform(-30.0, 30.0));
    const auto shape = shape_of(face);
    if (!shape) continue;
    Face out;
    out.weight = expressions_of(shape->features, rest, 0.0f);
    EXPECT_TRUE(is_valid(out));
    for (const Expression e : {Expression::kCheekPuff, Expression::kTongueOut,
                               Expression::kJawForward, Expression::kMouthDimpleLeft})
      EXPECT_EQ(out[e], 0.0f);
  }
  FaceLandmarks point;
  for (auto& p : point.image_px) p.setZero();
  EXPECT_FALSE(shape_of(point));
}

TEST(FaceSolver, LearnsTheFaceAtRestAndFadesWhereNoneIsSeen) {
  FaceSolver solver;
  Face out;
  EXPECT_FALSE(solver.write(picture_at(0), out));
  int picture = 0;
  for (; picture < 60; ++picture) {
    FaceLandmarks face = face_at_rest();
    // A blink now and then is not how a face is at rest.
    if (picture % 10 == 0) face.image_px[386].y() = face.image_px[159].y() = 5.0f;
    EXPECT_FALSE(solver.knows_rest());
    solver.see(face, picture_at(picture));
  }
  EXPECT_TRUE(solver.knows_rest());
  FaceLandmarks blinking = face_at_rest();
  blinking.image_px[386].y() = blinking.image_px[159].y() = 5.0f;
  for (; picture < 75; ++picture) solver.see(blinking, picture_at(picture));
  ASSERT_TRUE(solver.write(picture_at(picture), out));
  EXPECT_EQ(out.presence, kFaceSeen);
  EXPECT_GT(out[Expression::kEyeBlinkLeft], 0.9f);
  float last = 1.0f;
  for (int i = 0; i < 40; ++i, ++picture) {
    solver.see({}, picture_at(picture));
    solver.write(picture_at(picture), out);
    EXPECT_EQ(out.presence, 0u);
    EXPECT_LE(out[Expression::kEyeBlinkLeft], last);
    last = out[Expression::kEyeBlinkLeft];
  }
  EXPECT_EQ(last, 0.0f);
  EXPECT_FALSE(solver.write(picture_at(picture), out));
}

TEST(FaceSolver, AMirrorExchangesTheSides) {
  Face face;
  face[Expression::kEyeBlinkLeft] = 0.3f;
  face[Expression::kMouthSmileRight] = 0.6f;
  face[Expression::kJawLeft] = 0.2f;
  face[Expression::kMouthRight] = 0.1f;
  face[Expression::kJawOpen] = 0.9f;
  face[Expression::kMouthLowerDownLeft] = 0.4f;
  face.R_PB = Eigen::AngleAxisf(0.3f, Vector3f::UnitY());
  const Face before = face;
  mirror(face);
  EXPECT_EQ(face[Expression::kEyeBlinkRight], 0.3f);
  EXPECT_EQ(face[Expression::kMouthSmileLeft], 0.6f);
  EXPECT_EQ(face[Expression::kJawRight], 0.2f);
  EXPECT_EQ(face[Expression::kMouthLeft], 0.1f);
  EXPECT_EQ(face[Expression::kJawOpen], 0.9f);
  EXPECT_EQ(face[Expression::kMouthLowerDownRight], 0.4f);
  EXPECT_LT(face.R_PB.angularDistance(before.R_PB.conjugate()), 1e-4f);
  mirror(face);
  EXPECT_EQ(face.weight, before.weight);
}

}  // namespace
}  // namespace dance
