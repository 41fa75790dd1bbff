// The face of a mannequin: eyes turn, lids shut, the mouth smiles and speaks, for dancers of any
// proportions.
#include "formats/avatar/mannequin_model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "formats/body/figure_builder.h"

namespace dance {
namespace {

using Eigen::Vector3f;

// Vertices of one material in the axes of the head, in metres of a body 1.72 m tall, with one
// expression shown.
std::vector<Vector3f> shown(const AvatarModel& model, const Skeleton& skeleton,
                            std::string_view material, std::string_view expression = "") {
  const TposePlaces places(skeleton);
  std::vector<Vector3f> moved(model.vertices.size(), Vector3f::Zero());
  for (const AvatarExpression& each : model.expressions)
    if (each.name == expression)
      for (const auto& bind : each.binds) {
        const AvatarMorph& morph = model.morphs[bind.morph];
        for (std::size_t i = 0; i < morph.vertices.size(); ++i)
          moved[morph.vertices[i]] += bind.weight * morph.places_m[i];
      }
  std::vector<Vector3f> out;
  for (const AvatarPart& part : model.parts) {
    if (model.materials[part.material].name != material) continue;
    for (std::uint32_t i = 0; i < part.index_count; ++i) {
      const std::uint32_t v = model.triangles[part.first_index + i];
      out.push_back((model.vertices[v].place_m + moved[v] - places.at(Bone::kHead)) / places.scale);
    }
  }
  return out;
}

float extent(const std::vector<Vector3f>& places, int axis) {
  const auto [low, high] =
      std::ranges::minmax(places, {}, [axis](const Vector3f& p) { return p[axis]; });
  return high[axis] - low[axis];
}

AvatarModel mannequin(const Skeleton& skeleton, Hair hair) {
  GuestLook look = look_of(*GuestId::parse("alice"));
  look.hair_style = hair;
  return mannequin_model(skeleton, look, true);
}

class MannequinFace : public testing::TestWithParam<Hair> {};

TEST_P(MannequinFace, HasTheExpressionsAndEyesThatFacesMove) {
  const AvatarModel model = mannequin(average_skeleton(), GetParam());
  EXPECT_TRUE(is_sound(model));
  for (const char* name :
       {"aa", "ih", "ou", "ee", "oh", "happy", "blink", "blinkLeft", "blinkRight"}) {
    const auto found = std::ranges::find(model.expressions, name, &AvatarExpression::name);
    ASSERT_NE(found, model.expressions.end()) << name;
    EXPECT_FALSE(model.morphs[found->binds.at(0).morph].vertices.empty()) << name;
  }
  EXPECT_EQ(model.morphs.size(), 8u) << "each shape costs time at every vertex that it moves";
  for (const int eye : model.eyes) {
    ASSERT_GE(eye, 0);
    EXPECT_EQ(model.nodes[static_cast<std::size_t>(eye)].parent, model.node_of(Bone::kHead));
  }
}

TEST_P(MannequinFace, ShutLidsCoverTheEyesAndOpenOnesDoNot) {
  const Skeleton skeleton = average_skeleton(1.8f);
  const AvatarModel model = mannequin(skeleton, GetParam());
  const auto covers = [&](std::string_view expression) {
    int covered = 0;
    const auto pupils = shown(model, skeleton, "pupils");
    const auto lids = shown(model, skeleton, "skin", expression);
    const Vector3f pupil = *std::ranges::max_element(
        pupils, {}, [](const Vector3f& p) { return p.x() > 0.0f ? p.z() : 0.0f; });
    for (const Vector3f& lid : lids)
      covered += std::abs(lid.x() - pupil.x()) < 0.004f && std::abs(lid.y() - pupil.y()) < 0.004f &&
                 lid.z() > pupil.z() - 0.002f;
    return covered;
  };
  EXPECT_EQ(covers(""), 0);
  EXPECT_GT(covers("blink"), 0);
}

TEST_P(MannequinFace, SmilesAndSpeaks) {
  const Skeleton skeleton = average_skeleton(1.6f);
  const AvatarModel model = mannequin(skeleton, GetParam());
  const auto rest = shown(model, skeleton, "lips");
  const auto happy = shown(model, skeleton, "lips", "happy");
  EXPECT_GT(extent(happy, 0), extent(rest, 0) + 0.006f) << "a smile is wider";
  const auto corner_y_m = [](const std::vector<Vector3f>& lips) {
    return std::ranges::max(lips, {}, [](const Vector3f& p) { return p.x(); }).y();
  };
  EXPECT_GT(corner_y_m(happy), corner_y_m(rest) + 0.003f) << "and its corners are higher";
  EXPECT_GT(extent(shown(model, skeleton, "lips", "aa"), 1), extent(rest, 1) + 0.01f);
  EXPECT_LT(extent(shown(model, skeleton, "lips", "ou"), 0), 0.8f * extent(rest, 0));
}

TEST_P(MannequinFace, HairLeavesTheEyesFreeForAnyProportions) {
  std::vector<Skeleton> skeletons{average_skeleton(1.2f), average_skeleton(2.0f),
                                  average_skeleton()};
  skeletons[2].offset_m[index_of(Bone::kHead)] = Vector3f(0.0f, 0.2f, 0.03f);
  for (const Skeleton& skeleton : skeletons) {
    const AvatarModel model = mannequin(skeleton, GetParam());
    ASSERT_TRUE(is_sound(model));
    for (const Vector3f& place : shown(model, skeleton, "hair"))
      ASSERT_FALSE(place.z() > 0.09f && std::abs(std::abs(place.x()) - 0.03f) < 0.009f &&
                   std::abs(place.y() - 0.088f) < 0.01f)
          << place.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Styles, MannequinFace,
                         testing::Values(Hair::kShort, Hair::kBob, Hair::kBun, Hair::kPonytail));

}  // namespace
}  // namespace dance
