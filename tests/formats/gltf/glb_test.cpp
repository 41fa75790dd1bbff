#include "formats/gltf/glb.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace dance
