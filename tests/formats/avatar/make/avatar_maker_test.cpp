// Avatars of the project's own making: those that come with it, how they bend, blink and swing.
#include "formats/avatar/make/avatar_maker.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <png.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "formats/avatar/make/bent_figure.h"
#include "formats/avatar/vrm_writer.h"
#include "formats/body/figure_builder.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

using Eigen::Affine3f;
using Eigen::AngleAxisf;
using Eigen::Vector3f;

const AvatarModel& made(std::string_view name) {
  static std::map<std::string_view, AvatarModel> models;
  const auto [at, is_new] = models.try_emplace(name);
  if (is_new) at->second = make_avatar(*find_design(name));
  return at->second;
}

std::vector<std::uint8_t> file_of(const AvatarModel& model) {
  VrmMeta meta;
  meta.authors = {"DanceGraph"};
  meta.licence_url = kAvatarLicenceUrl;
  return write_vrm(model, meta).value();
}

// Places of all vertices with one bone turned.
std::vector<Vector3f> bent(const AvatarModel& model, Bone bone, const AngleAxisf& turn) {
  std::vector<Affine3f> world;
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const AvatarNode& node = model.nodes[n];
    Affine3f local = Affine3f::Identity();
    local.translate(node.translation_m);
    if (static_cast<int>(n) == model.node_of(bone)) local.rotate(turn);
    world.push_back(node.parent < 0 ? local : world[static_cast<std::size_t>(node.parent)] * local);
  }
  std::vector<Vector3f> places;
  for (const AvatarVertex& vertex : model.vertices) {
    Vector3f place = Vector3f::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const AvatarJoint& joint = model.joints[vertex.joints[k]];
      place +=
          static_cast<float>(vertex.weights[k]) / 255.0f *
          (world[static_cast<std::size_t>(joint.node)] * (joint.node_from_mesh * vertex.place_m));
    }
    places.push_back(place);
  }
  return places;
}

// Six times the volume below a part's triangles; closed surfaces only.
float volume(const AvatarModel& model, const AvatarPart& part,
             const std::vector<Vector3f>& places) {
  float sum = 0.0f;
  for (std::uint32_t i = 0; i < part.index_count; i += 3) {
    const std::uint32_t* v = &model.triangles[part.first_index + i];
    sum += places[v[0]].dot(places[v[1]].cross(places[v[2]]));
  }
  return sum;
}

TEST(AvatarMaker, ThoseThatComeWithTheProjectAreMadeAgainByteForByte) {
  if (MESHOPTIMIZER_VERSION != 180 || png_access_version_number() / 100 != 106)
    GTEST_SKIP() << "made with meshoptimizer 0.18 and libpng 1.6; here are others";
  for (const std::string_view name : design_names()) {
    const auto shipped = bytes_in(DANCE_SOURCE_DIR "/data/avatars/" + std::string(name) + ".vrm");
    EXPECT_TRUE(shipped == file_of(made(name))) << "make it again: dance avatar make --look "
                                                << name << " --out data/avatars/" << name << ".vrm";
  }
}

TEST(AvatarMaker, AreLightEnoughForAFloorWithThirtyDancers) {
  for (const std::string_view name : design_names()) {
    const AvatarModel& model = made(name);
    EXPECT_TRUE(is_sound(model));
    EXPECT_GE(model.triangles.size() / 3, 6'000u) << name;
    EXPECT_LE(model.triangles.size() / 3, 10'000u) << name;
    EXPECT_LT(file_of(model).size(), 500'000u) << name;
    EXPECT_TRUE(GuestId::parse(model.name));
  }
}

TEST(AvatarMaker, EveryGuestsLookMakesASoundAvatar) {
  for (const char* guest : {"alice", "bob", "carla", "x", "dancer-24"}) {
    const AvatarModel model = make_avatar(design_of(*GuestId::parse(guest)));
    EXPECT_TRUE(is_sound(model)) << guest;
    EXPECT_LE(model.triangles.size() / 3, 11'000u) << guest;
  }
}

TEST(AvatarMaker, StandOnTheFloorAsTallAsTheyAreDesigned) {
  for (const std::string_view name : design_names()) {
    float low = 9.0f;
    float high = -9.0f;
    for (const AvatarVertex& vertex : made(name).vertices) {
      low = std::min(low, vertex.place_m.y());
      high = std::max(high, vertex.place_m.y());
    }
    EXPECT_NEAR(low, 0.0f, 0.005f) << name;
    EXPECT_NEAR(high, find_design(name)->height_m, 0.05f) << name;
  }
}

// Each edge is passed once in each direction: simplifying opened no crack.
TEST(AvatarMaker, SimplifiedLayersAreClosed) {
  const Skeleton skeleton = average_skeleton(1.66f);
  const BentFigure figure(skeleton);
  const AvatarDesign design = *find_design("marisol");
  for (const FigureLayer& layer : FigureBuilder(skeleton, design.look, true).take_body()) {
    const Sheet sheet = figure.build_sheet(layer, 500);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t t = 0; t < sheet.triangles.size(); t += 3)
      for (std::size_t k = 0; k < 3; ++k)
        ++edges[{sheet.triangles[t + k], sheet.triangles[t + (k + 1) % 3]}];
    std::size_t open = 0;
    for (const auto& [edge, count] : edges) {
      const auto back = edges.find({edge.second, edge.first});
      open += back == edges.end() || back->second != count;
    }
    EXPECT_EQ(open, 0u) << static_cast<int>(layer.material);
    EXPECT_LE(sheet.triangles.size() / 3, 520u);
  }
}

// Skinned with a right angle a limb keeps most of its volume: no joint collapses.
TEST(AvatarMaker, JointsKeepTheirVolumeAtARightAngle) {
  const struct {
    Bone bone;
    AngleAxisf turn;
  } bends[] = {
      {Bone::kLeftLowerArm, AngleAxisf(-1.5708f, Vector3f::UnitY())},
      {Bone::kRightLowerArm, AngleAxisf(1.5708f, Vector3f::UnitY())},
      {Bone::kLeftLowerLeg, AngleAxisf(1.5708f, Vector3f::UnitX())},
      {Bone::kRightUpperLeg, AngleAxisf(-1.5708f, Vector3f::UnitX())},
      {Bone::kLeftUpperArm, AngleAxisf(-1.3f, Vector3f::UnitZ())},
      {Bone::kLeftHand, AngleAxisf(1.2f, Vector3f::UnitX())},
  };
  for (const std::string_view name : design_names()) {
    const AvatarModel& model = made(name);
    std::vector<Vector3f> rest;
    for (const AvatarVertex& vertex : model.vertices) rest.push_back(vertex.place_m);
    for (const auto& [bone, turn] : bends) {
      const std::vector<Vector3f> places = bent(model, bone, turn);
      for (const AvatarPart& part : model.parts) {
        const std::string& material = model.materials[part.material].name;
        if (material != "skin" && material != "trousers" && material != "cloth") continue;
        // Open cloth has no volume.
        if (model.materials[part.material].is_double_sided) continue;
        const float was = volume(model, part, rest);
        EXPECT_GT(volume(model, part, places), 0.93f * was)
            << name << " " << material << " " << kBones[index_of(bone)].name;
      }
    }
  }
}

// Round elbows and knees nothing comes much nearer to the limb's axis than it was.
TEST(AvatarMaker, ElbowsAndKneesStayRoundWhenTheyBend) {
  const struct {
    Bone parent, bone, child;
    AngleAxisf turn;
  } bends[] = {
      {Bone::kLeftUpperArm, Bone::kLeftLowerArm, Bone::kLeftHand,
       AngleAxisf(-1.5708f, Vector3f::UnitY())},
      {Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot,
       AngleAxisf(1.5708f, Vector3f::UnitX())},
  };
  const auto from_segment = [](const Vector3f& p, const Vector3f& a, const Vector3f& b) {
    const float t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0f, 1.0f);
    return (p - a - t * (b - a)).norm();
  };
  for (const std::string_view name : design_names()) {
    const AvatarModel& model = made(name);
    const auto rest_m = [&](Bone bone) -> Vector3f {
      return -model.joints[static_cast<std::size_t>(model.node_of(bone))]
                  .node_from_mesh.translation();
    };
    for (const auto& [parent, bone, child, turn] : bends) {
      const std::vector<Vector3f> places = bent(model, bone, turn);
      const Vector3f above = rest_m(parent);
      const Vector3f middle = rest_m(bone);
      const Vector3f below = middle + turn * (rest_m(child) - middle);
      float least = 1.0f;
      std::size_t near = 0;
      for (std::size_t v = 0; v < places.size(); ++v) {
        const AvatarVertex& vertex = model.vertices[v];
        const bool is_of_joint = vertex.joints[0] == index_of(bone) ||
                                 (vertex.weights[1] > 25 && vertex.joints[1] == index_of(bone));
        if (!is_of_joint || (vertex.place_m - middle).norm() > 0.09f) continue;
        const float was = from_segment(vertex.place_m, above, rest_m(child));
        const float is = std::min(from_segment(places[v], above, middle),
                                  from_segment(places[v], middle, below));
        least = std::min(least, is / was);
        ++near;
      }
      EXPECT_GT(near, 15u) << name;
      EXPECT_GT(least, 0.45f) << name << " " << kBones[index_of(bone)].name;
    }
  }
}

TEST(AvatarMaker, ShrugsLeaveTheHeadWhole) {
  for (const std::string_view name : design_names()) {
    const AvatarModel& model = made(name);
    const float chin_m = -model.joints[index_of(Bone::kHead)].node_from_mesh.translation().y();
    const auto places = bent(model, Bone::kLeftShoulder, AngleAxisf(0.6f, Vector3f::UnitZ()));
    float furthest_m = 0.0f;
    for (std::size_t v = 0; v < places.size(); ++v) {
      const Vector3f& rest = model.vertices[v].place_m;
      if (rest.y() > chin_m + 0.02f && std::abs(rest.x()) < 0.12f)
        furthest_m = std::max(furthest_m, (places[v] - rest).norm());
    }
    EXPECT_LT(furthest_m, 0.001f) << name;
  }
}

const AvatarMorph* morph_of(const AvatarModel& model, const std::string& name) {
  for (const AvatarMorph& morph : model.morphs)
    if (morph.name == name) return &morph;
  return nullptr;
}

TEST(AvatarMaker, EveryExpressionMovesTheFace) {
  for (const std::string_view name : design_names()) {
    const AvatarModel& model = made(name);
    std::set<std::string> names;
    for (const AvatarExpression& expression : model.expressions) {
      names.insert(expression.name);
      ASSERT_FALSE(expression.binds.empty()) << expression.name;
      for (const auto& bind : expression.binds) {
        float furthest_m = 0.0f;
        for (const Vector3f& move : model.morphs[bind.morph].places_m)
          furthest_m = std::max(furthest_m, move.norm());
        EXPECT_GT(furthest_m, 0.0015f) << expression.name;
        EXPECT_LT(furthest_m, 0.03f) << expression.name;
      }
    }
    for (const char* wanted : {"blink", "blinkLeft", "blinkRight", "aa", "ih", "ou", "ee", "oh",
                               "happy", "sad", "angry", "surprised", "relaxed"})
      EXPECT_TRUE(names.contains(wanted)) << wanted;
  }
}

TEST(AvatarMaker, ABlinkClosesOneEyeAndLeavesTheOther) {
  const AvatarModel& model = made("teo");
  const AvatarMorph* morph = morph_of(model, "blinkLeft");
  ASSERT_TRUE(morph);
  const auto eye = static_cast<std::size_t>(model.eyes[0]);
  const Vector3f middle = -model.joints[eye].node_from_mesh.translation();
  std::map<std::uint32_t, Vector3f> moves;
  for (std::size_t i = 0; i < morph->vertices.size(); ++i)
    moves[morph->vertices[i]] = morph->places_m[i];
  float open_low = 1.0f;
  float closed_low = 1.0f;
  for (const auto& [vertex, move] : moves) {
    const Vector3f place = model.vertices[vertex].place_m;
    ASSERT_GT(place.x(), 0.0f);
    // In the middle of the eye, seen from the front, above its middle at rest: the upper lid.
    if (std::abs(place.x() - middle.x()) > 0.004f || place.y() < middle.y()) continue;
    open_low = std::min(open_low, place.y() - middle.y());
    closed_low = std::min(closed_low, place.y() + move.y() - middle.y());
  }
  EXPECT_GT(open_low, 0.004f);
  EXPECT_LT(closed_low, -0.002f);
}

TEST(AvatarMaker, WhatSwingsHangsFromABoneAndKeepsClearOfTheBody) {
  for (const std::string_view name : design_names()) {
    const AvatarModel& model = made(name);
    ASSERT_GE(model.springs.size(), 2u);
    std::set<int> swinging;
    for (const AvatarSpring& spring : model.springs) {
      ASSERT_GE(spring.joints.size(), 3u);
      EXPECT_GE(spring.colliders.size(), 3u);
      int above = -1;
      for (const AvatarSpring::Joint& joint : spring.joints) {
        EXPECT_TRUE(swinging.insert(joint.node).second);
        if (above >= 0) {
          EXPECT_EQ(model.nodes[static_cast<std::size_t>(joint.node)].parent, above);
        }
        EXPECT_GT(joint.tail_m.norm(), 0.01f);
        above = joint.node;
      }
    }
    std::size_t tied = 0;
    for (const AvatarVertex& vertex : model.vertices)
      for (std::size_t k = 0; k < 4; ++k)
        tied += vertex.weights[k] > 0 && swinging.contains(vertex.joints[k]);
    EXPECT_GT(tied, 80u) << name;
  }
}

}  // namespace
}  // namespace dance
