#include "formats/body/body_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <set>

#include "formats/body/implicit_surface.h"

namespace dance {
namespace {

using Eigen::Vector3f;

GuestLook clothes(Sleeves sleeves, Legwear legwear, Hair hair) {
  GuestLook look = look_of(*GuestId::parse("alice"));
  look.sleeves = sleeves;
  look.legwear = legwear;
  look.hair_style = hair;
  return look;
}

const std::vector<std::vector<BodyMeshPart>>& bodies() {
  static const std::vector<std::vector<BodyMeshPart>> kBodies{
      body_mesh(average_skeleton(1.6f), clothes(Sleeves::kShort, Legwear::kSkirt, Hair::kBob),
                true),
      body_mesh(average_skeleton(1.9f), clothes(Sleeves::kLong, Legwear::kFlared, Hair::kBun),
                false),
      body_mesh(average_skeleton(1.2f),
                clothes(Sleeves::kNone, Legwear::kTrousers, Hair::kPonytail), true)};
  return kBodies;
}

// Each edge is passed once in each direction: no hole, no fold, no triangle turned round.
TEST(BodyMesh, EverySurfaceIsClosed) {
  for (const auto& body : bodies())
    for (const BodyMeshPart& part : body) {
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
      for (std::size_t t = 0; t < part.triangles.size(); t += 3)
        for (std::size_t k = 0; k < 3; ++k)
          ++edges[{part.triangles[t + k], part.triangles[t + (k + 1) % 3]}];
      std::size_t open = 0;
      for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        open += back == edges.end() || back->second != count;
      }
      EXPECT_EQ(open, 0u) << static_cast<int>(part.material);
    }
}

TEST(BodyMesh, NormalsAreUnitAndPointOutOfTheTriangles) {
  for (const auto& body : bodies())
    for (const BodyMeshPart& part : body) {
      ASSERT_EQ(part.normals.size(), part.places_m.size());
      for (const Vector3f& normal : part.normals) ASSERT_NEAR(normal.norm(), 1.0f, 1e-4f);
      std::size_t wrong = 0;
      for (std::size_t t = 0; t < part.triangles.size(); t += 3) {
        const auto at = [&](std::size_t k) -> const Vector3f& {
          return part.places_m[part.triangles[t + k]];
        };
        const Vector3f face = (at(1) - at(0)).cross(at(2) - at(0));
        Vector3f normal = Vector3f::Zero();
        for (std::size_t k = 0; k < 3; ++k) normal += part.normals[part.triangles[t + k]];
        wrong += face.dot(normal) < 0.0f;
      }
      // Slivers where two round parts meet at a sharp angle.
      EXPECT_LE(wrong * 200, part.triangles.size() / 3) << static_cast<int>(part.material);
    }
}

TEST(BodyMesh, EveryVertexFollowsBonesOfTheBodyByWeightsOf255) {
  for (std::size_t b = 0; b < bodies().size(); ++b) {
    const std::size_t joints = kBoneCount + kFingerBoneCount;
    for (const BodyMeshPart& part : bodies()[b]) {
      ASSERT_EQ(part.skin.size(), part.places_m.size());
      for (const SkinWeights& skin : part.skin) {
        int sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          sum += skin.weights[k];
          ASSERT_LT(skin.joints[k], b == 1 ? kBoneCount : joints);
        }
        ASSERT_EQ(sum, 255);
      }
    }
  }
}

// A leg that is lifted takes nothing of the other leg with it, and no arm takes the ribs.
TEST(BodyMesh, LimbsFollowTheirOwnSide) {
  const auto weight_of = [](const SkinWeights& skin, Bone bone) {
    int weight = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (skin.joints[k] == index_of(bone)) weight += skin.weights[k];
    return weight;
  };
  const Skeleton skeleton = average_skeleton(1.9f);
  const float knee_y_m = skeleton.hips_height_m() + skeleton.offset(Bone::kLeftUpperLeg).y() +
                         skeleton.offset(Bone::kLeftLowerLeg).y();
  std::size_t thighs = 0;
  for (const BodyMeshPart& part : bodies()[1])
    for (std::size_t v = 0; v < part.places_m.size(); ++v) {
      const Vector3f& p = part.places_m[v];
      if (part.material != Material::kLegs || std::abs(p.y() - knee_y_m) > 0.2f) continue;
      ++thighs;
      EXPECT_EQ(weight_of(part.skin[v], p.x() > 0.0f ? Bone::kRightLowerLeg : Bone::kLeftLowerLeg),
                0);
      EXPECT_EQ(weight_of(part.skin[v], p.x() > 0.0f ? Bone::kRightUpperLeg : Bone::kLeftUpperLeg),
                0);
    }
  EXPECT_GT(thighs, 500u);
}

TEST(BodyMesh, TrousersOfNarrowHipsHaveTwoLegs) {
  Skeleton skeleton = average_skeleton();
  for (const float s : {1.0f, -1.0f})
    skeleton.offset_m[index_of(s > 0 ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg)].x() = 0.06f * s;
  const auto is_left = [](const SkinWeights& skin) {
    int weight = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (skin.joints[k] >= index_of(Bone::kLeftUpperLeg))
        weight +=
            skin.joints[k] < index_of(Bone::kRightUpperLeg) ? skin.weights[k] : -skin.weights[k];
    return weight > 0;
  };
  for (const BodyMeshPart& part :
       body_mesh(skeleton, clothes(Sleeves::kLong, Legwear::kFlared, Hair::kBun), false)) {
    if (part.material != Material::kLegs) continue;
    std::size_t bridges = 0;
    for (std::size_t t = 0; t < part.triangles.size(); t += 3) {
      const auto side_of = [&](std::size_t k) { return is_left(part.skin[part.triangles[t + k]]); };
      const bool is_low = part.places_m[part.triangles[t]].y() < 0.6f;
      bridges += is_low && (side_of(0) != side_of(1) || side_of(0) != side_of(2));
    }
    EXPECT_EQ(bridges, 0u);
  }
}

// A skeleton like CMU's, whose first joint of the back lies in the hips.
TEST(BodyMesh, AShirtEndsAtTheWaistWhereverTheBackBegins) {
  const auto hem_of = [](const Skeleton& skeleton) {
    float low = 9.0f;
    int of_spine = 0;  // weights of the cloth below the waist
    for (const BodyMeshPart& part :
         body_mesh(skeleton, clothes(Sleeves::kLong, Legwear::kTrousers, Hair::kBun), false)) {
      if (part.material != Material::kTop) continue;
      for (std::size_t v = 0; v < part.places_m.size(); ++v) {
        low = std::min(low, part.places_m[v].y());
        if (part.places_m[v].y() > skeleton.hips_height_m() + 0.02f) continue;
        for (std::size_t k = 0; k < 4; ++k)
          if (part.skin[v].joints[k] == index_of(Bone::kSpine)) of_spine += part.skin[v].weights[k];
      }
    }
    return std::pair(low, of_spine);
  };
  Skeleton low_back = average_skeleton();
  low_back.offset_m[index_of(Bone::kChest)] += low_back.offset(Bone::kSpine);
  low_back.offset_m[index_of(Bone::kSpine)].setZero();
  const auto [usual, none] = hem_of(average_skeleton());
  const auto [low, of_spine] = hem_of(low_back);
  EXPECT_EQ(none, 0);
  EXPECT_EQ(of_spine, 0);
  EXPECT_NEAR(low, usual, 0.01f);
}

TEST(BodyMesh, StandsOnTheFloorAndIsAsTallAsTheDancer) {
  const float heights_m[] = {1.6f, 1.9f, 1.2f};
  for (std::size_t b = 0; b < bodies().size(); ++b) {
    float low = 10.0f;
    float high = -10.0f;
    for (const BodyMeshPart& part : bodies()[b])
      for (const Vector3f& p : part.places_m) {
        low = std::min(low, p.y());
        high = std::max(high, p.y());
      }
    EXPECT_NEAR(low, 0.0f, 0.012f);
    EXPECT_NEAR(high, standing_height_m(average_skeleton(heights_m[b])), 0.03f);
  }
}

TEST(BodyMesh, BodiesOfExtremeProportionsStayBounded) {
  Skeleton skeleton = average_skeleton();
  for (auto& offset : skeleton.offset_m) offset = Vector3f(1.9f, -0.3f, 0.2f);
  for (auto& tip : skeleton.tip_m) tip = Vector3f::Zero();
  ASSERT_TRUE(is_valid(skeleton));
  for (const BodyMeshPart& part :
       body_mesh(skeleton, clothes(Sleeves::kLong, Legwear::kTrousers, Hair::kBun), true)) {
    EXPECT_LT(part.places_m.size(), 2'000'000u);
    for (const Vector3f& p : part.places_m) ASSERT_TRUE(p.allFinite());
    for (const Vector3f& n : part.normals) ASSERT_TRUE(n.allFinite());
  }
}

}  // namespace
}  // namespace dance
