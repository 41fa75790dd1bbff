// Heads of figures whose skeletons have unusual proportions: skin, hair and eyes stay together
// while shoulders and head move.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "core/pose/kinematics.h"
#include "formats/body/body_mesh.h"
#include "formats/body/figure_builder.h"

namespace dance {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

struct Proportions {
  const char* name;
  Skeleton skeleton;
};

std::vector<Proportions> unusual() {
  std::vector<Proportions> all{{"average", average_skeleton()}};
  const auto add = [&](const char* name) -> Skeleton& {
    all.push_back({name, average_skeleton()});
    return all.back().skeleton;
  };
  const auto at = [](Skeleton& s, Bone bone) -> Vector3f& { return s.offset_m[index_of(bone)]; };
  add("short head end").tip_m[0] = Vector3f(0.0f, 0.01f, 0.0f);
  add("long head end").tip_m[0] = Vector3f(0.0f, 0.45f, 0.0f);
  add("head end that points forward").tip_m[0] = Vector3f(0.0f, 0.02f, 0.2f);
  at(add("neck in the skull"), Bone::kHead) = Vector3f(0.0f, 0.002f, 0.0f);
  at(add("neck above the head"), Bone::kHead) = Vector3f(0.0f, -0.03f, 0.02f);
  at(add("long neck"), Bone::kHead) = Vector3f(0.0f, 0.2f, 0.03f);
  // MakeHuman's proportions: collar bones begin in the middle, the head's joint is at the ears.
  Skeleton& narrow = add("narrow collar bones");
  at(narrow, Bone::kHead) = Vector3f(0.0f, 0.111f, 0.003f);
  for (const float s : {1.0f, -1.0f}) {
    at(narrow, s > 0 ? Bone::kLeftShoulder : Bone::kRightShoulder) = {0.023f * s, 0.105f, 0.041f};
    at(narrow, s > 0 ? Bone::kLeftUpperArm : Bone::kRightUpperArm) = {0.149f * s, -0.022f, -0.003f};
  }
  Skeleton& high = add("shoulders beside the chin");
  for (const Bone bone : {Bone::kLeftShoulder, Bone::kRightShoulder}) at(high, bone).y() = 0.24f;
  return all;
}

// Shoulders drop, arms rise, the head turns and nods.
Pose moved() {
  Pose pose;
  const auto turn = [&](Bone bone, float angle, const Vector3f& axis) {
    pose.R_PB[index_of(bone)] = Quaternionf(AngleAxisf(angle, axis)) * pose.R_PB[index_of(bone)];
  };
  turn(Bone::kLeftShoulder, -0.5f, Vector3f::UnitZ());
  turn(Bone::kRightShoulder, 0.5f, Vector3f::UnitZ());
  turn(Bone::kLeftUpperArm, 0.9f, Vector3f::UnitZ());
  turn(Bone::kRightUpperArm, -0.9f, Vector3f::UnitZ());
  turn(Bone::kUpperChest, 0.3f, Vector3f::UnitX());
  turn(Bone::kHead, 0.7f, Vector3f::UnitY());
  turn(Bone::kHead, 0.3f, Vector3f::UnitX());
  return pose;
}

// A figure's vertices in the axes of its head, in metres of a body 1.72 m tall.
class HeadView {
 public:
  HeadView(const Skeleton& skeleton, const Pose& pose) : rest_(skeleton) {
    forward_kinematics(skeleton, pose, frames_);
  }
  Vector3f at_rest(const Vector3f& place_m) const {
    return (place_m - rest_.at(Bone::kHead)) / rest_.scale;
  }
  Vector3f posed(const Vector3f& place_m, const SkinWeights& skin) const {
    Vector3f sum = Vector3f::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t b = skin.joints[k];
      if (skin.weights[k] == 0 || b >= kBoneCount) continue;
      sum += static_cast<float>(skin.weights[k]) / 255.0f *
             (frames_.p_WB_m[b] + frames_.R_WB[b] * (place_m - rest_.bones_m[b]));
    }
    const Quaternionf& R_WH = frames_.R_WB[index_of(Bone::kHead)];
    return R_WH.conjugate() * (sum - frames_.position(Bone::kHead)) / rest_.scale;
  }

 private:
  TposePlaces rest_;
  BodyFrames frames_;
};

struct Heads {
  std::vector<Vector3f> skin, hair, eyes, irises;  // posed, in the head's axes
  float furthest_m = 0.0f;                         // skin of the head that left its place
};

Heads heads_of(const Skeleton& skeleton, const GuestLook& look) {
  const HeadView view(skeleton, moved());
  Heads heads;
  for (const BodyMeshPart& part : body_mesh(skeleton, look, false))
    for (std::size_t v = 0; v < part.places_m.size(); ++v) {
      const Vector3f rest = view.at_rest(part.places_m[v]);
      // Hands of a raised arm are skin too.
      if (rest.y() < 0.02f || std::abs(rest.x()) > 0.15f) continue;
      const Vector3f posed = view.posed(part.places_m[v], part.skin[v]);
      if (part.material == Material::kSkin) {
        heads.skin.push_back(posed);
        heads.furthest_m = std::max(heads.furthest_m, (posed - rest).norm());
      }
      if (part.material == Material::kHair) heads.hair.push_back(posed);
      if (part.material == Material::kEyeWhite) heads.eyes.push_back(posed);
      if (part.material == Material::kIris) heads.irises.push_back(posed);
    }
  return heads;
}

// Brows are of the hair's material too: what covers an eye lies before its ball.
bool covers_an_eye(const Vector3f& place) {
  return place.z() > 0.09f && std::abs(std::abs(place.x()) - 0.03f) < 0.009f &&
         std::abs(place.y() - 0.09f) < 0.012f;
}

float distance_to(const std::vector<Vector3f>& places, const Vector3f& from) {
  float nearest = 1.0f;
  for (const Vector3f& place : places) nearest = std::min(nearest, (place - from).norm());
  return nearest;
}

class HeadProportions : public testing::TestWithParam<Hair> {};

TEST_P(HeadProportions, KeepHairOnTheScalpAndEyesUncovered) {
  GuestLook look = look_of(*GuestId::parse("alice"));
  look.hair_style = GetParam();
  look.legwear = Legwear::kTrousers;
  for (const Proportions& proportions : unusual()) {
    SCOPED_TRACE(proportions.name);
    const Heads heads = heads_of(proportions.skeleton, look);
    ASSERT_GT(heads.skin.size(), 500u);
    ASSERT_GT(heads.irises.size(), 20u);
    EXPECT_LT(heads.furthest_m, 0.001f);
    EXPECT_EQ(std::ranges::count_if(heads.hair, covers_an_eye), 0);
    EXPECT_EQ(std::ranges::count_if(heads.skin, covers_an_eye), 0);
    // Eyes lie in the skull, and the cap of hair on it.
    const auto widest = std::ranges::max(heads.skin, {}, [](const Vector3f& p) {
      return std::abs(p.y() - 0.11f) < 0.02f ? p.x() : 0.0f;
    });
    EXPECT_NEAR(widest.x(), 0.076f, 0.012f);
    for (const Vector3f& eye : heads.eyes) EXPECT_LT(distance_to(heads.skin, eye), 0.025f);
    for (std::size_t i = 0; i < heads.hair.size(); i += 7) {
      const bool is_cap = heads.hair[i].y() > 0.16f && heads.hair[i].z() > -0.05f;
      EXPECT_LT(is_cap ? distance_to(heads.skin, heads.hair[i]) : 0.0f, 0.025f);
    }
  }
}

// Buns and ponytails differ from short hair behind the head alone.
INSTANTIATE_TEST_SUITE_P(Styles, HeadProportions, testing::Values(Hair::kShort, Hair::kBob));

}  // namespace
}  // namespace dance
