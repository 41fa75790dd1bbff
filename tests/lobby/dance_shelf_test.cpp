// The recordings in the window: listed, offered after a dance, renamed and deleted.
#include "lobby/run/dance_shelf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/test_folder.h"

namespace dance {
namespace {

struct DanceShelfTest : testing::Test {
  void put(const std::string& name) const {
    std::filesystem::copy_file(DANCE_SOURCE_DIR "/logs/couple.lcm", folder.path(name));
  }
  void list() {
    shelf.apply(model, LobbyWish::kListDances);
    while (shelf.is_busy()) shelf.poll(model);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const RecordedDance& dance : model.shelf.dances) all.push_back(dance.name());
    std::sort(all.begin(), all.end());
    return all;
  }
  TestFolder folder{"dance-shelf"};
  DanceShelf shelf{{folder.path()}};
  LobbyModel model;
};

TEST_F(DanceShelfTest, ReadsAFewRecordingsEachTurnUntilAllAreRead) {
  for (int i = 0; i < 9; ++i) put(std::to_string(i) + ".lcm");
  list();
  ASSERT_EQ(model.shelf.dances.size(), 9u);
  for (const RecordedDance& dance : model.shelf.dances) EXPECT_EQ(dance.guests.size(), 2u);
}

TEST_F(DanceShelfTest, OffersToShowARecordingMadeDuringADance) {
  put("before.lcm");
  shelf.note_dance_begins();
  shelf.note_dance_ends(model);
  EXPECT_TRUE(model.banners.empty()) << "nothing was recorded";
  shelf.note_dance_begins();
  put("during.lcm");
  shelf.note_dance_ends(model);
  ASSERT_EQ(model.banners.size(), 1u);
  EXPECT_EQ(model.banners[0].text, Text::kLobbySavedDance);
  EXPECT_EQ(model.banners[0].wish, LobbyWish::kWatch);
  EXPECT_EQ(model.shelf.chosen, folder.path("during.lcm"));
}

TEST_F(DanceShelfTest, RenamesTheChosenOneOrReportsWhyNot) {
  put("a.lcm");
  put("b.lcm");
  list();
  model.shelf.chosen = folder.path("a.lcm");
  model.shelf.name_typed = "b";
  shelf.apply(model, LobbyWish::kRename);
  ASSERT_EQ(model.banners.size(), 1u);
  EXPECT_EQ(model.banners[0].text, Text::kLobbyNotRenamed);
  model.shelf.name_typed = "c";
  shelf.apply(model, LobbyWish::kRename);
  EXPECT_TRUE(model.banners.empty());
  EXPECT_EQ(names(), (std::vector<std::string>{"b", "c"}));
  EXPECT_EQ(model.shelf.chosen, folder.path("c.lcm"));
}

TEST_F(DanceShelfTest, DeletesOnlyTheChosenOne) {
  put("a.lcm");
  put("b.lcm");
  list();
  model.shelf.chosen = folder.path("gone.lcm");
  shelf.apply(model, LobbyWish::kDelete);
  EXPECT_EQ(names().size(), 2u);
  model.shelf.chosen = folder.path("a.lcm");
  shelf.apply(model, LobbyWish::kDelete);
  EXPECT_EQ(names(), std::vector<std::string>{"b"});
  EXPECT_TRUE(model.shelf.chosen.empty());
}

TEST(DanceShelf, ParsesThePercentageOfAnExport) {
  EXPECT_EQ(percent_in("writing: 45 %"), 45);
  for (const char* line :
       {"", "writing: ", "writing: x %", "writing: 101 %", "writing: -1 %", "45"})
    EXPECT_EQ(percent_in(line), -1) << line;
}

}  // namespace
}  // namespace dance
