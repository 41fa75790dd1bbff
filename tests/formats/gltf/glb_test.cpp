#include "formats/gltf/glb.h"

#include <gtest/gtest.h>

#include "formats/gltf/glb_container.h"
#include "tests/formats/gltf/glb_clips.h"

namespace dance {
namespace {

using test::expect_same_places;
using test::random_dance;

TEST(Glb, IsReadAgainToATenthOfAMillimetre) {
  for (const bool has_hands : {false, true}) {
    const std::vector<NamedClip> dance{random_dance("alice", 1, 40, has_hands),
                                       random_dance("bob", 2, 40, has_hands)};
    const auto bytes = write_glb(dance);
    ASSERT_TRUE(bytes.has_value()) << bytes.error().what;
    const auto again = read_glb(*bytes);
    ASSERT_TRUE(again.has_value()) << again.error().what;
    ASSERT_EQ(again->size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ((*again)[i].name, dance[i].name);
      EXPECT_DOUBLE_EQ((*again)[i].clip.frame_hz, 60.0);
      EXPECT_EQ((*again)[i].clip.hands.size(), has_hands ? 40u : 0u);
      expect_same_places(dance[i].clip, (*again)[i].clip);
    }
  }
}

// A file whose mesh is a head: the skin names no legs.
TEST(Glb, FindsTheWholeFigureAroundTheSkinOfAHead) {
  const std::vector<NamedClip> dance{random_dance("alice", 1, 10, false)};
  const auto bytes = write_glb(dance);
  ASSERT_TRUE(bytes.has_value()) << bytes.error().what;
  auto model = unpacked_model(*bytes, {});
  ASSERT_TRUE(model.has_value()) << model.error().what;
  tinygltf::Skin skin;
  for (std::size_t n = 0; n < model->nodes.size(); ++n)
    if (model->nodes[n].name == "head") skin.joints.push_back(static_cast<int>(n));
  ASSERT_EQ(skin.joints.size(), 1u);
  model->skins.assign(1, skin);
  const auto packed = packed_glb(*model);
  ASSERT_TRUE(packed.has_value()) << packed.error().what;
  const auto again = read_glb(*packed);
  ASSERT_TRUE(again.has_value()) << again.error().what;
  ASSERT_EQ(again->size(), 1u);
  expect_same_places(dance[0].clip, (*again)[0].clip);
}

}  // namespace
}  // namespace dance
