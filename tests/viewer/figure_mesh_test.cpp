// Meshes and their levels of detail, without a graphics card; trails of hands and the beat's pulse.

#include "viewer/mesh/figure_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <thread>

#include "core/pose/skeleton.h"
#include "formats/avatar/mannequin_model.h"
#include "formats/body/guest_look.h"
#include "tests/viewer/sheet_figure.h"
#include "viewer/mesh/mesh_maker.h"
#include "viewer/stage/floor_painter.h"
#include "viewer/stage/hand_trails.h"

namespace dance {
namespace {

using Eigen::Vector3f;

const AvatarModel& mannequin() {
  static const AvatarModel model =
      mannequin_model(average_skeleton(), look_of(*GuestId::parse("alice")), false);
  return model;
}

TEST(FigureMesh, HasFewerAndFewerTrianglesOverTheFirstVertices) {
  const auto mesh = figure_mesh(mannequin());
  ASSERT_GE(mesh->levels.size(), 4u);
  EXPECT_EQ(mesh->levels[0].triangle_count, mannequin().triangles.size() / 3);
  EXPECT_LE(mesh->levels.back().triangle_count, 1000u);
  EXPECT_GE(mesh->levels.back().triangle_count, 400u);
  for (std::size_t l = 0; l < mesh->levels.size(); ++l) {
    const FigureLevel& level = mesh->levels[l];
    if (l > 0) {
      EXPECT_LT(level.triangle_count, mesh->levels[l - 1].triangle_count);
    }
    std::uint32_t triangles = 0;
    for (const FigureLevel::Range& range : level.batches) {
      ASSERT_LE(range.first_index + range.index_count, mesh->indices.size());
      triangles += range.index_count / 3;
      for (std::uint32_t i = 0; i < range.index_count; ++i)
        ASSERT_LT(mesh->indices[range.first_index + i], level.vertex_count);
    }
    EXPECT_EQ(triangles, level.triangle_count);
  }
  EXPECT_EQ(level_for(*mesh, 1e9), 0u);
  EXPECT_EQ(level_for(*mesh, 1.0), mesh->levels.size() - 1);
}

// Small figures still have a smile and visible eyes.
TEST(FigureMesh, KeepsTheFaceInCoarseLevels) {
  const auto mesh = figure_mesh(mannequin());
  const FigureLevel& level = mesh->levels[level_for(*mesh, 2000.0)];
  ASSERT_LT(level.triangle_count, 6000u);
  std::map<std::string, int> kept;  // triangles of each material
  for (const FigureLevel::Range& range : level.batches)
    for (std::uint32_t i = 0; i < range.index_count; i += 3) {
      const FigureVertex& vertex = mesh->vertices[mesh->indices[range.first_index + i]];
      ++kept[mannequin().materials[vertex.material & 0xffu].name];
    }
  EXPECT_GE(kept["lips"], 12);
  EXPECT_GE(kept["irises"], 8);
  EXPECT_GE(kept["pupils"], 4);
  EXPECT_GE(kept["eyes"], 8);
}

TEST(FigureMesh, DrawsAMannequinOfManyMaterialsInOneCall) {
  EXPECT_GT(mannequin().materials.size(), 5u);
  EXPECT_EQ(figure_mesh(mannequin())->batches.size(), 1u);
}

// Rings of vertices round the knees, or they would break like sticks.
TEST(FigureMesh, KeepsVerticesWhereLegsBend) {
  const auto mesh = figure_mesh(mannequin());
  const FigureLevel& coarse = mesh->levels.back();
  const Skeleton skeleton = average_skeleton();
  const float knee_m = skeleton.hips_height_m() + skeleton.offset(Bone::kLeftUpperLeg).y() +
                       skeleton.offset(Bone::kLeftLowerLeg).y();
  int near_knees = 0;
  for (std::uint32_t v = 0; v < coarse.vertex_count; ++v)
    near_knees += std::abs(mesh->vertices[v].place_m[1] - knee_m) < 0.06f;
  EXPECT_GE(near_knees, 12);
}

TEST(FigureMesh, KeepsWeightsAndOrdersThem) {
  const auto mesh = figure_mesh(mannequin());
  for (const FigureVertex& vertex : mesh->vertices) {
    int sum = 0;
    for (const std::uint8_t weight : vertex.weights) sum += weight;
    ASSERT_EQ(sum, 255);
    ASSERT_TRUE(std::is_sorted(vertex.weights.rbegin(), vertex.weights.rend()));
  }
}

TEST(FigureMesh, KeepsTheOrderOfWhatIsBlended) {
  const auto mesh = figure_mesh(
      sheet_model({plain(1, 0, 0, 0.5f), plain(1, 1, 1), plain(0, 1, 0, 0.5f), plain(1, 1, 0)}));
  ASSERT_EQ(mesh->batches.size(), 3u);
  EXPECT_EQ(mesh->batches[0].alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(mesh->batches[1].alpha_mode, AlphaMode::kOpaque) << "both that are solid";
  EXPECT_EQ(mesh->levels[0].batches[1].index_count, 12u);
  EXPECT_EQ(mesh->batches[2].alpha_mode, AlphaMode::kBlend);
}

TEST(FigureMesh, HasOnlyVerticesThatMoveInItsMorphs) {
  AvatarModel model = sheet_model({plain(1, 0, 0)});
  AvatarMorph morph;
  morph.vertices = {0, 1, 2};
  morph.places_m = {Vector3f(0, 0.5f, 0), Vector3f::Zero(), Vector3f(0.25f, 0, 0)};
  model.morphs.push_back(morph);
  const auto mesh = figure_mesh(model);
  EXPECT_EQ(mesh->morph_steps.size(), 2u);
  EXPECT_EQ(std::count_if(mesh->vertices.begin(), mesh->vertices.end(),
                          [](const FigureVertex& v) { return v.morphs >> 24 == 1; }),
            2);
}

TEST(FigureMesh, OfAModelWithoutTrianglesHasNone) {
  const auto mesh = figure_mesh(sheet_model({}));
  ASSERT_EQ(mesh->levels.size(), 1u);
  EXPECT_EQ(mesh->levels[0].triangle_count, 0u);
}

TEST(MeshMaker, BuildsBesideAndForgetsModelsOfGuestsWhoWent) {
  MeshMaker maker;
  maker.set_when(MeshMaker::When::kBeside);
  auto model = std::make_shared<const AvatarModel>(mannequin());
  EXPECT_EQ(maker.take(model), nullptr);
  std::shared_ptr<const FigureMesh> mesh;
  for (int i = 0; i < 10'000 && mesh == nullptr; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    mesh = maker.take(model);
  }
  ASSERT_NE(mesh, nullptr);
  EXPECT_EQ(mesh->indices, figure_mesh(*model)->indices);
  EXPECT_EQ(model.use_count(), 1);
  const std::weak_ptr<const AvatarModel> gone = model;
  EXPECT_EQ(maker.take(model), nullptr);  // begins anew
  model.reset();
  const auto other = std::make_shared<const AvatarModel>(sheet_model({plain(1, 1, 1)}));
  for (int i = 0; i < 10'000 && !gone.expired(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    (void)maker.take(other);
  }
  EXPECT_TRUE(gone.expired());
}

PosedFigure with_hand_at(const Vector3f& place_W_m) {
  static const auto model = std::make_shared<const AvatarModel>(sheet_model({plain(1, 1, 1)}));
  PosedFigure figure = figure_at("alice", model, Vector3f::Zero());
  figure.frames.p_WT_m.fill(place_W_m);
  for (const Bone hand : {Bone::kLeftHand, Bone::kRightHand})
    figure.frames.p_WB_m[index_of(hand)] = place_W_m;
  return figure;
}
MonoTime at_ms(std::int64_t ms) { return MonoTime::from_us(1'000'000 + 1000 * ms); }

TEST(HandTrails, FollowTheHandAndFade) {
  HandTrails trails;
  for (int i = 0; i <= 30; ++i)
    trails.add(at_ms(20 * i),
               std::array{with_hand_at(Vector3f(0.02f * static_cast<float>(i), 1.0f, 0.0f))});
  std::vector<RibbonVertex> triangles;
  trails.append_ribbons(Vector3f(0, 1, 5), triangles);
  ASSERT_GT(triangles.size(), 2u * 30u * 6u - 1u);
  ASSERT_EQ(triangles.size() % 3, 0u);
  float oldest = 1.0f, newest = 0.0f;
  for (const RibbonVertex& vertex : triangles) {
    EXPECT_NEAR(vertex.place_W_m.y(), 1.0f, 0.03f);
    EXPECT_GE(vertex.place_W_m.x(), -1e-4f);
    EXPECT_LE(vertex.place_W_m.x(), 0.6f + 1e-4f);
    if (vertex.place_W_m.x() < 0.03f) oldest = std::min(oldest, vertex.strength);
    if (vertex.place_W_m.x() > 0.57f) newest = std::max(newest, vertex.strength);
  }
  EXPECT_GT(newest, 4.0f * oldest);
}

TEST(HandTrails, BeginAnewAfterAJumpInTimeOrPlace) {
  const auto count_after = [](MonoTime time, const Vector3f& place) {
    HandTrails trails;
    for (int i = 0; i < 10; ++i)
      trails.add(at_ms(20 * i), std::array{with_hand_at(Vector3f::Zero())});
    trails.add(time, std::array{with_hand_at(place)});
    std::vector<RibbonVertex> triangles;
    trails.append_ribbons(Vector3f(0, 1, 5), triangles);
    return triangles.size();
  };
  EXPECT_GT(count_after(at_ms(200), Vector3f::Zero()), 0u);
  EXPECT_EQ(count_after(at_ms(20), Vector3f::Zero()), 0u) << "back in time";
  EXPECT_EQ(count_after(at_ms(2000), Vector3f::Zero()), 0u) << "long after";
  EXPECT_EQ(count_after(at_ms(200), Vector3f(2, 0, 0)), 0u) << "elsewhere";
}

TEST(BeatPulse, IsStrongestOnTheBeatAndMoreSoOnTheOne) {
  const auto glow = [](double beats, int beats_per_bar) {
    return pulse_of({beats, 2.0, beats_per_bar}).glow;
  };
  EXPECT_GT(glow(8.0, 4), 1.5f * glow(9.0, 4));
  EXPECT_GT(glow(9.0, 4), 3.0f * glow(9.5, 4));
  EXPECT_FLOAT_EQ(glow(8.0, 0), glow(9.0, 0)) << "where nobody knows the bars";
  EXPECT_GT(glow(-4.0, 4), 1.5f * glow(-3.0, 4)) << "before the music's first beat";
  EXPECT_GT(pulse_of({8.5, 2.0, 4}).radius_m, pulse_of({8.0, 2.0, 4}).radius_m);
}

}  // namespace
}  // namespace dance
