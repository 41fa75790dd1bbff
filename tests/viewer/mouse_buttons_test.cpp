// Tests that panels, which read the mouse once a picture, get clicks between two pictures.
#include "viewer/window/mouse_buttons.h"

#include <gtest/gtest.h>

#include <vector>

namespace dance {
namespace {

using Change = MouseButtons::Change;

std::vector<Change> next_picture(MouseButtons& buttons) {
  std::vector<Change> seen;
  const std::size_t count = buttons.take([&](const Change& change) { seen.push_back(change); });
  EXPECT_EQ(count, seen.size());
  return seen;
}

TEST(MouseButtons, PassAClickThatIsShorterThanAPictureInTwoPictures) {
  MouseButtons buttons;
  buttons.add({0, true, 10.0f, 20.0f});
  buttons.add({0, false, 30.0f, 40.0f});
  const auto first = next_picture(buttons);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_TRUE(first[0].is_down);
  EXPECT_EQ(first[0].x_px, 10.0f);
  const auto second = next_picture(buttons);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_FALSE(second[0].is_down);
  EXPECT_EQ(second[0].y_px, 40.0f);
  EXPECT_TRUE(next_picture(buttons).empty());
}

TEST(MouseButtons, PassChangesOfDifferentButtonsTogetherAndInTheirOrder) {
  MouseButtons buttons;
  buttons.add({0, true});
  buttons.add({1, true});
  buttons.add({0, false});
  buttons.add({1, false});
  EXPECT_EQ(next_picture(buttons).size(), 2u);
  EXPECT_EQ(next_picture(buttons).size(), 2u);
  EXPECT_TRUE(next_picture(buttons).empty());
}

TEST(MouseButtons, DropWhatExceedsTheirBoundAndButtonsThatPanelsDoNotKnow) {
  MouseButtons buttons;
  buttons.add({MouseButtons::kButtons, true});
  EXPECT_TRUE(next_picture(buttons).empty());
  for (std::size_t i = 0; i < MouseButtons::kMost + 5; ++i) buttons.add({0, i % 2 == 0});
  std::size_t pictures = 0;
  while (!next_picture(buttons).empty()) ++pictures;
  EXPECT_EQ(pictures, MouseButtons::kMost);
}

}  // namespace
}  // namespace dance
