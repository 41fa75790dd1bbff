// Avatars of others, as they were found, with what is known of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "formats/avatar/avatar_reader.h"
#include "formats/avatar/read/avatar_nodes.h"

namespace dance {
namespace {

struct Counts {
  std::size_t nodes, joints, vertices, triangles, materials, pictures;
  auto operator<=>(const Counts&) const = default;
};

class AvatarFiles : public ::testing::Test {
 protected:
  void read(const std::string& file) {
    const std::filesystem::path path =
        std::filesystem::path(DANCE_SOURCE_DIR) / "../shared/data/avatars" / file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    auto read = read_avatar({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    ASSERT_TRUE(read) << read.error().what;
    model_ = std::move(read->model);
    notes_ = std::move(read->notes);
    EXPECT_TRUE(is_sound(model_));
  }
  Counts counts() const {
    return {model_.nodes.size(),         model_.joints.size(),    model_.vertices.size(),
            model_.triangles.size() / 3, model_.materials.size(), model_.pictures.size()};
  }
  std::string node_of(Bone bone) const {
    const int node = model_.node_of(bone);
    return node < 0 ? "-" : model_.nodes[static_cast<std::size_t>(node)].name;
  }
  Eigen::Vector3d place_of(Bone bone) const {
    return rest_transforms(model_)[static_cast<std::size_t>(model_.node_of(bone))].translation();
  }

  std::size_t finger_count() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(model_.fingers, [](int node) { return node >= 0; }));
  }

  AvatarModel model_;
  std::vector<std::string> notes_;
};

// All face +Z and stand on the floor: the left hand at +X, toes before the ankles.
void expect_stance(const std::function<Eigen::Vector3d(Bone)>& place) {
  EXPECT_GT(place(Bone::kLeftHand).x(), place(Bone::kRightHand).x() + 0.8);
  EXPECT_GT(place(Bone::kHead).y(), place(Bone::kHips).y() + 0.3);
  EXPECT_GT(place(Bone::kLeftToes).z(), place(Bone::kLeftFoot).z() + 0.02);
  EXPECT_GT(place(Bone::kRightToes).z(), place(Bone::kRightFoot).z() + 0.02);
  EXPECT_NEAR(place(Bone::kHips).x(), 0.0, 0.01);
}

TEST_F(AvatarFiles, AVrmOf2020FacesTheOtherWayAndIsTurned) {
  read("cryptovoxels.vrm");
  if (IsSkipped()) return;
  EXPECT_EQ(counts(), (Counts{74, 57, 2727, 4907, 1, 0}));
  EXPECT_TRUE(notes_.empty()) << notes_.front();
  EXPECT_EQ(node_of(Bone::kHips), "Hips");
  EXPECT_EQ(node_of(Bone::kChest), "Chest");
  EXPECT_EQ(node_of(Bone::kUpperChest), "-");
  EXPECT_EQ(node_of(Bone::kRightLowerArm), "Right elbow");
  EXPECT_EQ(node_of(Bone::kLeftToes), "Left toe");
  EXPECT_EQ(finger_count(), 22u);  // it tells no thumbs and no last bones of the index fingers
  expect_stance([this](Bone bone) { return place_of(bone); });
  EXPECT_FLOAT_EQ(model_.materials[0].emission.x(), 0.1132075f);
  EXPECT_FLOAT_EQ(model_.materials[0].roughness, 0.529000044f);
}

TEST_F(AvatarFiles, UnrealsNamesAreUnderstood) {
  read("mesh2motion_human-female.glb");
  if (IsSkipped()) return;
  EXPECT_EQ(counts(), (Counts{68, 66, 24037, 14244, 2, 0}));
  EXPECT_EQ(model_.parts.size(), 2u);
  EXPECT_EQ(node_of(Bone::kHips), "pelvis");
  EXPECT_EQ(node_of(Bone::kSpine), "spine_01");
  EXPECT_EQ(node_of(Bone::kUpperChest), "spine_03");
  EXPECT_EQ(node_of(Bone::kLeftShoulder), "clavicle_l");
  EXPECT_EQ(node_of(Bone::kRightToes), "ball_r");
  EXPECT_EQ(finger_count(), 30u);
  EXPECT_NEAR(model_.materials[0].base_colour.x(), 0.5714685f, 1e-6f);
  EXPECT_TRUE(model_.materials[0].is_double_sided);
  expect_stance([this](Bone bone) { return place_of(bone); });
}

TEST_F(AvatarFiles, AFigureWithOneFingerHasItsPicture) {
  read("mesh2motion_human-kenney.glb");
  if (IsSkipped()) return;
  EXPECT_EQ(counts(), (Counts{41, 39, 1029, 1604, 1, 1}));
  EXPECT_EQ(node_of(Bone::kUpperChest), "UpperChest");
  EXPECT_EQ(finger_count(), 10u);
  ASSERT_EQ(model_.materials[0].picture, 0);
  EXPECT_EQ(model_.pictures[0].width_px, 1024);
  EXPECT_EQ(model_.pictures[0].height_px, 1024);
  expect_stance([this](Bone bone) { return place_of(bone); });
}

TEST_F(AvatarFiles, ASmallPictureKeepsItsSize) {
  read("mesh2motion_human-male.glb");
  if (IsSkipped()) return;
  EXPECT_EQ(counts(), (Counts{68, 66, 7399, 13757, 1, 1}));
  EXPECT_EQ(model_.pictures[0].width_px, 499);
  EXPECT_EQ(model_.pictures[0].height_px, 500);
  EXPECT_EQ(finger_count(), 30u);
  expect_stance([this](Bone bone) { return place_of(bone); });
}

}  // namespace
}  // namespace dance
