#include "formats/clip/dancers_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "formats/kind/file_kind.h"
#include "tests/formats/gltf/glb_clips.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr const char* kBvh = DANCE_SOURCE_DIR "/tests/formats/bvh/data/mixamo.bvh";

class DancersFile : public testing::Test {
 protected:
  std::string couple() {
    GlbOptions options;
    options.has_bodies = false;
    const auto bytes = write_glb(
        {test::random_dance("alice", 1, 12, false), test::random_dance("bob", 2, 12, false)},
        options);
    std::ofstream(folder_.path("couple.glb"), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes->data()),
               static_cast<std::streamsize>(bytes->size()));
    return folder_.path("couple.glb");
  }
  TestFolder folder_{"dancers-file"};
};

TEST_F(DancersFile, ABvhHoldsOneDancerWithoutAName) {
  const auto dancers = load_dancers(kBvh);
  ASSERT_TRUE(dancers.has_value()) << dancers.error().what;
  ASSERT_EQ(dancers->size(), 1u);
  EXPECT_EQ(dancers->front().name, "");
  EXPECT_TRUE(load_dancer(kBvh, "carol").has_value());
}

TEST_F(DancersFile, AGlbHoldsAllWhoDanceInItByTheirNames) {
  const auto dancers = load_dancers(couple());
  ASSERT_TRUE(dancers.has_value()) << dancers.error().what;
  ASSERT_EQ(dancers->size(), 2u);
  EXPECT_EQ(dancers->at(0).name, "alice");
  EXPECT_EQ(dancers->at(1).name, "bob");
}

TEST_F(DancersFile, TheEndOfAGlbsNameIsTakenInAnyCaseAndAsAnAvatar) {
  const std::string file = couple();
  for (const char* name : {"COUPLE.GLB", "Couple.vrm", "couple.Vrma"}) {
    std::filesystem::copy_file(file, folder_.path(name));
    const auto dancers = load_dancers(folder_.path(name));
    ASSERT_TRUE(dancers.has_value()) << dancers.error().what;
    EXPECT_EQ(dancers->size(), 2u) << name;
    EXPECT_EQ(input_kind(folder_.path(name)).value(), FileKind::kGlb) << name;
  }
}

TEST_F(DancersFile, OfSeveralTheNamedOneIsTakenAndOthersAreListed) {
  const std::string file = couple();
  const auto bob = load_dancer(file, "bob");
  ASSERT_TRUE(bob.has_value()) << bob.error().what;
  EXPECT_EQ(bob->name, "bob");
  const auto carol = load_dancer(file, "carol");
  ASSERT_FALSE(carol.has_value());
  EXPECT_EQ(carol.error().what, file +
                                    ": several dance in it, and none is called carol; there are "
                                    "alice, bob");
}

TEST_F(DancersFile, AGlbStaysWhereItIsAndIsScaledOnlyWhereOneSaysSo) {
  const std::string file = couple();
  const auto as_is = load_dancer(file, "alice");
  ASSERT_TRUE(as_is.has_value());
  test::expect_same_places(test::random_dance("alice", 1, 12, false).clip, as_is->clip);
  RetargetOptions in_decimetres;
  in_decimetres.metres_per_unit = 0.1;
  const auto small = load_dancer(file, "alice", in_decimetres);
  ASSERT_TRUE(small.has_value()) << small.error().what;
  EXPECT_NEAR(standing_height_m(small->clip.skeleton),
              0.1f * standing_height_m(as_is->clip.skeleton), 1e-3f);
}

TEST_F(DancersFile, ErrorsNameTheFile) {
  EXPECT_NE(load_dancers(folder_.path("none.glb")).error().what.find("none.glb"),
            std::string::npos);
  std::ofstream(folder_.path("broken.glb")) << "glTF";
  const auto broken = load_dancers(folder_.path("broken.glb"));
  ASSERT_FALSE(broken.has_value());
  EXPECT_EQ(broken.error().what.find(folder_.path("broken.glb") + ": "), 0u);
}

}  // namespace
}  // namespace dance
