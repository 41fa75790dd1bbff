// Figures whose pixels are known, drawn alone: their light is read before tone and sRGB.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/viewer/driver_memory.h"
#include "tests/viewer/sheet_figure.h"
#include "viewer/gl/offscreen.h"
#include "viewer/gl/picture_target.h"
#include "viewer/stage/figure_drawer.h"

namespace dance {
namespace {

using Eigen::Vector3f;
using Model = std::shared_ptr<const AvatarModel>;
constexpr int kSide_px = 200;

// Looks along -Z at a square of 4 m by 4 m round the origin: 50 pixels to a metre there.
OrbitCamera straight_camera(float yaw_rad = 0.0f) {
  OrbitCamera camera;
  camera.target_W_m = Vector3f::Zero();
  camera.yaw_rad = yaw_rad;
  camera.pitch_rad = 0.0f;
  camera.distance_m = 20.0f;
  camera.fov_y_rad = 2.0f * std::atan(2.0f / 20.0f);
  return camera;
}

class FigureDrawingTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = OffscreenContext::create();
    if (made) {
      context_ = std::move(*made);
      keep_drivers_loaded();
    } else {
      why_not_ = made.error().what;
    }
  }
  static void TearDownTestSuite() { context_.reset(); }
  void SetUp() override {
    if (!context_) GTEST_SKIP() << why_not_;
    drawer_ = std::make_unique<FigureDrawer>(Quality::kHigh);
    light_ = std::make_unique<StageLight>(256);
    target_ = std::make_unique<PictureTarget>(4);
    ASSERT_TRUE(target_->resize(kSide_px, kSide_px));
  }
  void TearDown() override {
    drawer_.reset();
    light_.reset();
    target_.reset();
  }

  void draw(std::span<const PosedFigure> figures, float yaw_rad = 0.0f,
            const StageLook& look = {}) {
    const OrbitCamera camera = straight_camera(yaw_rad);
    const auto taken = drawer_->take(figures, eye_of(camera, kSide_px, kSide_px), look);
    ASSERT_TRUE(taken) << taken.error().what;
    target_->bind_light();
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const Eigen::Matrix4f clip = camera.clip_from_world(1.0f);
    drawer_->draw_solid(*light_, clip, camera.eye_W_m(), FigureImage::kNone);
    drawer_->draw_blended(*light_, clip, camera.eye_W_m());
    target_->resolve_light();
    glBindTexture(GL_TEXTURE_2D, target_->light().name());
    pixels_.resize(std::size_t{4} * kSide_px * kSide_px);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, pixels_.data());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }
  // Linear colour at a place of the plane through the origin.
  Vector3f at(float x_m, float y_m) const {
    const auto x = static_cast<std::size_t>(kSide_px / 2 + 50.0f * x_m);
    const auto y = static_cast<std::size_t>(kSide_px / 2 + 50.0f * y_m);
    const float* pixel = &pixels_[4 * (y * kSide_px + x)];
    return {pixel[0], pixel[1], pixel[2]};
  }
  static Model shared(AvatarModel model) {
    return std::make_shared<const AvatarModel>(std::move(model));
  }

  static inline std::unique_ptr<OffscreenContext> context_;
  static inline std::string why_not_;
  std::unique_ptr<FigureDrawer> drawer_;
  std::unique_ptr<StageLight> light_;
  std::unique_ptr<PictureTarget> target_;
  std::vector<float> pixels_;
};

#define EXPECT_COLOUR(place, r, g, b) \
  EXPECT_LT((place - Vector3f(r, g, b)).norm(), 0.03f) << (place).transpose()

// Top left red, top right green, bottom left blue, bottom right white.
AvatarPicture four_colours() {
  AvatarPicture picture;
  picture.width_px = picture.height_px = 64;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool left = x < 32, top = y < 32;
      const auto on = [](bool is) { return static_cast<std::uint8_t>(is ? 255 : 0); };
      for (const std::uint8_t part :
           {on(left == top && (top || !left)), on(!left), on(!top), std::uint8_t{255}})
        picture.rgba.push_back(part);
    }
  return picture;
}

TEST_F(FigureDrawingTest, PutsPicturesTheRightWayUp) {
  AvatarModel model = sheet_model({plain(1, 1, 1)});
  model.pictures.push_back(four_colours());
  model.materials[0].picture = 0;
  const std::array figures{figure_at("alice", shared(model), Vector3f::Zero())};
  draw(figures);
  EXPECT_COLOUR(at(-0.25f, 0.25f), 1, 0, 0);
  EXPECT_COLOUR(at(0.25f, 0.25f), 0, 1, 0);
  EXPECT_COLOUR(at(-0.25f, -0.25f), 0, 0, 1);
  EXPECT_COLOUR(at(0.25f, -0.25f), 1, 1, 1);
  EXPECT_COLOUR(at(0.7f, 0.0f), 0, 0, 0);
}

TEST_F(FigureDrawingTest, LeavesHolesWhereAMaskSaysSo) {
  AvatarModel model = sheet_model({plain(1, 0, 0), plain(0, 1, 0)});
  AvatarPicture picture = four_colours();
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    const bool left = (i / 4) % 64 < 32;
    picture.rgba[i] = picture.rgba[i + 1] = picture.rgba[i + 2] = 255;
    picture.rgba[i + 3] = left ? 60 : 200;
  }
  model.pictures.push_back(picture);
  model.materials[0].picture = 0;
  model.materials[0].alpha_mode = AlphaMode::kMask;
  const std::array figures{figure_at("alice", shared(model), Vector3f::Zero())};
  draw(figures);
  EXPECT_COLOUR(at(-0.25f, 0.0f), 0, 1, 0);  // through the hole
  EXPECT_COLOUR(at(0.25f, 0.0f), 1, 0, 0);
}

TEST_F(FigureDrawingTest, BlendsFarBeforeNearWhateverTheOrderOfGuests) {
  const Model red = shared(sheet_model({plain(1, 0, 0, 0.5f)}));
  const Model green = shared(sheet_model({plain(0, 1, 0, 0.5f)}));
  std::array figures{figure_at("alice", red, Vector3f(0, 0, 0.5f)),
                     figure_at("bob", green, Vector3f(0, 0, -0.5f))};
  for (int order = 0; order < 2; ++order) {
    draw(figures);
    EXPECT_COLOUR(at(0.0f, 0.0f), 0.5f, 0.25f, 0);
    std::swap(figures[0], figures[1]);
  }
}

TEST_F(FigureDrawingTest, ShowsBacksOfDoubleSidedSheetsOnly) {
  AvatarModel model = sheet_model({plain(1, 1, 0)});
  const float behind = 3.14159265f;
  draw(std::array{figure_at("alice", shared(model), Vector3f::Zero())}, behind);
  EXPECT_COLOUR(at(0.0f, 0.0f), 0, 0, 0);
  model.materials[0].is_double_sided = true;
  draw(std::array{figure_at("alice", shared(model), Vector3f::Zero())}, behind);
  EXPECT_COLOUR(at(0.0f, 0.0f), 1, 1, 0);
}

TEST_F(FigureDrawingTest, MovesWithItsMorphsEachFigureByItsOwnWeights) {
  AvatarModel model = sheet_model({plain(1, 0, 1)});
  for (const float up_m : {0.0f, 1.0f}) {  // the second of two
    AvatarMorph morph;
    for (std::uint32_t v = 0; v < 4; ++v) {
      morph.vertices.push_back(v);
      morph.places_m.emplace_back(0.0f, up_m, 0.0f);
    }
    model.morphs.push_back(morph);
  }
  const Model shared_model = shared(model);
  std::array figures{figure_at("alice", shared_model, Vector3f(-1, 0, 0)),
                     figure_at("bob", shared_model, Vector3f(1, 0, 0))};
  draw(figures);
  EXPECT_COLOUR(at(1.0f, 0.0f), 1, 0, 1);
  figures[1].morph_weights = {1.0f, 1.0f};
  draw(figures);
  EXPECT_COLOUR(at(-1.0f, 0.0f), 1, 0, 1);
  EXPECT_COLOUR(at(1.0f, 0.0f), 0, 0, 0);
  EXPECT_COLOUR(at(1.0f, 1.0f), 1, 0, 1);
}

TEST_F(FigureDrawingTest, DrawsEveryFigureOfTwoModelsInOneCallForEach) {
  const Model red = shared(sheet_model({plain(1, 0, 0)}));
  const Model blue = shared(sheet_model({plain(0, 0, 1)}));
  const std::array figures{
      figure_at("a", red, Vector3f(-1, -1, 0)), figure_at("b", blue, Vector3f(1, -1, 0)),
      figure_at("c", red, Vector3f(1, 1, 0)), figure_at("d", blue, Vector3f(-1, 1, 0))};
  draw(figures);
  EXPECT_COLOUR(at(-1, -1), 1, 0, 0);
  EXPECT_COLOUR(at(1, -1), 0, 0, 1);
  EXPECT_COLOUR(at(1, 1), 1, 0, 0);
  EXPECT_COLOUR(at(-1, 1), 0, 0, 1);
  EXPECT_EQ(drawer_->drawn().figures, 4u);
  EXPECT_EQ(drawer_->drawn().calls, 2u);
}

TEST_F(FigureDrawingTest, BlendsTheMatricesOfAVertexByItsWeights) {
  AvatarModel model = sheet_model({plain(0, 1, 1)});
  model.joints.resize(3);
  for (AvatarVertex& vertex : model.vertices) {
    vertex.joints = {1, 2, 0, 0};
    vertex.weights = {102, 153, 0, 0};
  }
  PosedFigure figure = figure_at("alice", shared(model), Vector3f::Zero());
  figure.W_from_joint[0].col(3) = Vector3f(9, 9, 9);
  figure.W_from_joint[1].col(3) = Vector3f(-1.0f, 0, 0);
  figure.W_from_joint[2].col(3) = Vector3f(1.5f, 0, 0);
  draw(std::array{figure});  // -0.4 + 0.9 = 0.5
  EXPECT_COLOUR(at(0.05f, 0.0f), 0, 1, 1);
  EXPECT_COLOUR(at(0.95f, 0.0f), 0, 1, 1);
  EXPECT_COLOUR(at(-0.1f, 0.0f), 0, 0, 0);
  EXPECT_COLOUR(at(1.1f, 0.0f), 0, 0, 0);
}

TEST_F(FigureDrawingTest, ShadesAToonInTwoTones) {
  AvatarModel model = sheet_model({plain(0.5f, 0.5f, 0.5f)});
  model.materials[0].shading = Shading::kToon;
  model.materials[0].shade_colour = Vector3f(0.5f, 0, 0);
  model.materials[0].is_double_sided = true;
  model.materials[0].shade_toony = 0.95f;
  const Model toon = shared(model);
  light_->set_yaw(0.75f);  // from the front
  light_->shine_on(Vector3f::Zero(), 50.0f);
  light_->begin_map();  // nothing casts a shadow
  light_->end_map();
  draw(std::array{figure_at("alice", toon, Vector3f::Zero())});
  EXPECT_GT(at(0, 0).y(), 0.4f) << "lit, in its base colour";
  draw(std::array{figure_at("alice", toon, Vector3f::Zero())}, 3.14159265f);
  EXPECT_LT(at(0, 0).y(), 0.1f) << "the back is in its shade colour";
  EXPECT_GT(at(0, 0).x(), 0.2f);
}

TEST_F(FigureDrawingTest, HidesOnlyTheOwnHeadInFirstPerson) {
  AvatarModel model = sheet_model({plain(1, 0, 0)});
  model.nodes.resize(2);
  model.bones.fill(0);
  model.bones[index_of(Bone::kHead)] = 1;
  model.joints.resize(2);
  model.joints[1].node = 1;
  for (AvatarVertex& vertex : model.vertices) vertex.joints = {1, 0, 0, 0};
  const Model head = shared(model);
  const std::array figures{figure_at("alice", head, Vector3f(-1, 0, 0)),
                           figure_at("bob", head, Vector3f(1, 0, 0))};
  StageLook look;
  look.through_eyes_of = *GuestId::parse("alice");
  draw(figures, 0.0f, look);
  EXPECT_COLOUR(at(-1, 0), 0, 0, 0);
  EXPECT_COLOUR(at(1, 0), 1, 0, 0);
}

TEST_F(FigureDrawingTest, FreesModelsThatNobodyWears) {
  const auto bytes_before = drawer_->store().bytes();
  {
    const Model red = shared(sheet_model({plain(1, 0, 0)}));
    draw(std::array{figure_at("alice", red, Vector3f::Zero())});
    EXPECT_EQ(drawer_->store().models(), 1u);
    EXPECT_GT(drawer_->store().bytes(), bytes_before);
  }
  draw({});
  EXPECT_EQ(drawer_->store().models(), 0u) << "its last owner has gone";
  EXPECT_EQ(drawer_->store().bytes(), bytes_before);
  const Model kept = shared(sheet_model({plain(1, 0, 0)}));
  draw(std::array{figure_at("alice", kept, Vector3f::Zero())});
  for (int picture = 0; picture < 300; ++picture) draw({});
  EXPECT_EQ(drawer_->store().models(), 0u) << "somebody keeps it, but nobody wears it";
  draw(std::array{figure_at("alice", kept, Vector3f::Zero())});
  EXPECT_COLOUR(at(0, 0), 1, 0, 0);
}

TEST_F(FigureDrawingTest, DrawsWhatIsTooLargeWithSmallPicturesOrNotAtAll) {
  AvatarModel model = sheet_model({plain(1, 1, 1)});
  AvatarPicture picture;
  picture.width_px = picture.height_px = 1024;
  picture.rgba.assign(std::size_t{4} * 1024 * 1024, 255);
  model.pictures.push_back(picture);
  model.materials[0].picture = 0;
  const std::array figures{figure_at("alice", shared(model), Vector3f::Zero())};
  drawer_->store().set_most_bytes(1 << 20);
  draw(figures);
  EXPECT_COLOUR(at(0, 0), 1, 1, 1);
  EXPECT_LE(drawer_->store().bytes(), std::size_t{1} << 20);
  EXPECT_EQ(drawer_->store().left_out(), 0u);
  drawer_ = std::make_unique<FigureDrawer>(Quality::kHigh);
  drawer_->store().set_most_bytes(1000);
  draw(figures);
  EXPECT_COLOUR(at(0, 0), 0, 0, 0);
  EXPECT_EQ(drawer_->store().left_out(), 1u);
  EXPECT_EQ(drawer_->waiting().size(), 1u);
}

}  // namespace
}  // namespace dance
