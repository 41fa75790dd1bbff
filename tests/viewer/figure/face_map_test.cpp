#include "viewer/figure/rig/face_map.h"

#include <gtest/gtest.h>

#include "tests/viewer/figure/test_rigs.h"

namespace dance {
namespace {

AvatarModel with_morphs(std::initializer_list<const char*> names) {
  AvatarModel model = mannequin_of(average_skeleton());
  model.morphs.clear();
  model.expressions.clear();
  for (const char* name : names) {
    AvatarMorph morph;
    morph.name = name;
    morph.vertices = {0};
    morph.places_m = {Eigen::Vector3f(0.0f, 0.01f, 0.0f)};
    model.morphs.push_back(morph);
  }
  return model;
}

AvatarModel arkit_model() {
  return with_morphs({"jawOpen", "EyeBlink_L", "eyeBlinkRight", "MouthSmileLeft", "mouthSmileRight",
                      "browInnerUp", "mouthFunnel", "mouthPucker", "eyeWideLeft", "eyeWideRight",
                      "cheekPuff", "hairShort"});
}

AvatarModel vrm_model() {
  AvatarModel model = with_morphs({"Fcl_MTH_A", "Fcl_EYE_Close", "Fcl_EYE_Close_L"});
  model.expressions = {{"aa", {{0, 0.5f}}}, {"blink", {{1, 1.0f}}}, {"blinkLeft", {{2, 1.0f}}}};
  return model;
}

Face laughing() {
  Face face;
  face.presence = kFaceSeen;
  face[Expression::kJawOpen] = 0.8f;
  face[Expression::kEyeBlinkLeft] = 1.0f;
  face[Expression::kEyeBlinkRight] = 0.4f;
  face[Expression::kMouthSmileLeft] = 0.6f;
  return face;
}

TEST(FaceMap, MovesMorphsOfArKitsNames) {
  const FaceMap map(arkit_model());
  std::vector<float> weights(12, 0.0f);
  map.add(laughing(), weights);
  EXPECT_FLOAT_EQ(weights[0], 0.8f);
  EXPECT_FLOAT_EQ(weights[1], 1.0f) << "EyeBlink_L";
  EXPECT_FLOAT_EQ(weights[2], 0.4f);
  EXPECT_FLOAT_EQ(weights[3], 0.6f);
  for (std::size_t i = 4; i < weights.size(); ++i) EXPECT_EQ(weights[i], 0.0f) << i;
}

TEST(FaceMap, OrVrmsVowelsAndLids) {
  const FaceMap map(vrm_model());
  std::vector<float> weights(3, 0.0f);
  map.add(laughing(), weights);
  EXPECT_FLOAT_EQ(weights[0], 0.4f) << "half as far as the expression goes";
  EXPECT_FLOAT_EQ(weights[1], 0.4f) << "of both lids";
  EXPECT_FLOAT_EQ(weights[2], 0.6f) << "and what the left one does beyond";
}

TEST(FaceMap, NeverBothSets) {
  AvatarModel model = arkit_model();
  model.expressions = {{"aa", {{0, 1.0f}}}, {"blink", {{1, 1.0f}, {2, 1.0f}}}};
  std::vector<float> weights(12, 0.0f);
  FaceMap(model).add(laughing(), weights);
  EXPECT_FLOAT_EQ(weights[0], 0.8f) << "the mouth is not opened twice";
  EXPECT_FLOAT_EQ(weights[2], 0.4f);
}

TEST(FaceMap, SmilesAndLooksByVrmsExpressionsWhereArKitsAreMissing) {
  AvatarModel vrm = with_morphs({"smile", "left", "right", "up"});
  vrm.expressions = {{"happy", {{0, 1.0f}}},
                     {"lookLeft", {{1, 1.0f}}},
                     {"lookRight", {{2, 1.0f}}},
                     {"lookUp", {{3, 1.0f}}}};
  Face face = laughing();
  face[Expression::kEyeLookOutLeft] = face[Expression::kEyeLookInRight] = 0.25f;
  std::vector<float> weights(4, 0.0f);
  const FaceMap map(vrm);
  map.add(face, weights);
  EXPECT_FLOAT_EQ(weights[0], 0.3f) << "one corner of two";
  EXPECT_FLOAT_EQ(weights[1], 0.25f);
  EXPECT_EQ(weights[2], 0.0f);
  EXPECT_TRUE(map.has_look());
  EXPECT_FALSE(FaceMap(vrm_model()).has_look());

  AvatarModel arkit = arkit_model();
  arkit.expressions = {{"lookLeft", {{11, 1.0f}}}, {"happy", {{11, 1.0f}}}};
  std::vector<float> mixed(12, 0.0f);
  FaceMap(arkit).add(face, mixed);
  EXPECT_FLOAT_EQ(mixed[11], 0.25f) << "it has ARKit's smile, and no look of its own";
}

TEST(FaceMap, WeightsStayWithinTheirBounds) {
  AvatarModel model = vrm_model();
  model.expressions[0].binds = {{0, 1.0f}, {0, 1.0f}, {77, 1.0f}};
  std::vector<float> weights{0.9f, 0.0f, 0.0f};
  FaceMap(model).add(laughing(), weights);
  EXPECT_EQ(weights[0], 1.0f);
}

TEST(FaceMap, AFigureWithoutAFaceHasNone) {
  EXPECT_TRUE(FaceMap(with_morphs({"hairShort"})).is_empty());
  EXPECT_FALSE(FaceMap(vrm_model()).is_empty());
}

// Through the poser: the face that is seen takes the place of blinking.
TEST(FaceMap, IsShownByTheFigure) {
  SceneState scene;
  scene.time = MonoTime() + Duration::s(5);
  SceneGuest guest;
  guest.id = *GuestId::parse("alice");
  guest.avatar = std::make_shared<const AvatarModel>(arkit_model());
  guest.face = laughing();
  scene.guests.push_back(guest);
  FigurePoser poser;
  const auto figures = poser.pose(scene);
  ASSERT_EQ(figures.size(), 1u);
  ASSERT_EQ(figures[0].morph_weights.size(), 12u);
  EXPECT_FLOAT_EQ(figures[0].morph_weights[0], 0.8f);
  scene.guests[0].face.reset();
  EXPECT_EQ(poser.pose(scene)[0].morph_weights[0], 0.0f);
}

}  // namespace
}  // namespace dance
