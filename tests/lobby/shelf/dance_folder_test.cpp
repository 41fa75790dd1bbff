// Folders with recordings: the files that are listed, and names that reach no other folder.
#include "lobby/shelf/dance_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/test_folder.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

struct DanceFolder : testing::Test {
  void put(const std::string& name, int age_s = 0) const {
    std::ofstream(folder.path(name)) << "x";
    fs::last_write_time(folder.path(name),
                        fs::file_time_type::clock::now() - std::chrono::seconds(age_s));
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const RecordedDance& dance : dances_in({folder.path()})) all.push_back(dance.name());
    return all;
  }
  TestFolder folder{"dance-folder"};
};

TEST_F(DanceFolder, ListsRecordingsTheNewestFirst) {
  put("old.lcm", 100);
  put("new.lcm", 1);
  put("song.ogg");
  put(".hidden.lcm");
  put("new.lcm.index");
  fs::create_directories(folder.path("folder.lcm"));
  EXPECT_EQ(names(), (std::vector<std::string>{"new", "old"}));
  const auto twice = dances_in({folder.path(), folder.path(), folder.path("nowhere")});
  EXPECT_EQ(twice.size(), 2u) << "each once";
}

TEST_F(DanceFolder, NamesAreBoundedAndStayInTheFolder) {
  for (const char* name : {"salsa", "Salsa con Ana", "Tanz 3.5", "baile ñ", "-o"})
    EXPECT_TRUE(is_dance_name(name)) << name;
  for (const std::string& name :
       {std::string(), std::string("../x"), std::string("a/b"), std::string("."),
        std::string(".hidden"), std::string("a\nb"), std::string("a\0b", 3), std::string("a\u202e"),
        std::string("\xff"), std::string(" a"), std::string(81, 'a')})
    EXPECT_FALSE(is_dance_name(name)) << name;
}

TEST_F(DanceFolder, RenamesWithItsIndexAndOverwritesNothing) {
  put("a.lcm");
  put("a.lcm.index");
  put("b.lcm");
  EXPECT_FALSE(rename_dance(folder.path("a.lcm"), "b"));
  EXPECT_FALSE(rename_dance(folder.path("a.lcm"), "../b2"));
  fs::create_symlink("nowhere", folder.path("link.lcm"));
  EXPECT_FALSE(rename_dance(folder.path("a.lcm"), "link"));
  EXPECT_TRUE(fs::is_symlink(folder.path("link.lcm")));
  const auto renamed = rename_dance(folder.path("a.lcm"), "c");
  ASSERT_TRUE(renamed) << renamed.error().what;
  EXPECT_EQ(*renamed, folder.path("c.lcm"));
  EXPECT_TRUE(fs::exists(folder.path("c.lcm.index")));
  EXPECT_EQ(*rename_dance(*renamed, "c.lcm"), *renamed) << "the same name changes nothing";
  EXPECT_FALSE(rename_dance(folder.path("gone.lcm"), "d"));
}

TEST_F(DanceFolder, DeletesOneAndItsIndex) {
  put("a.lcm");
  put("a.lcm.index");
  put("b.lcm");
  ASSERT_TRUE(delete_dance(folder.path("a.lcm")));
  EXPECT_FALSE(fs::exists(folder.path("a.lcm.index")));
  EXPECT_EQ(names(), std::vector<std::string>{"b"});
}

TEST_F(DanceFolder, ExportsHaveNamesThatAreNotTaken) {
  put("a.lcm");
  EXPECT_EQ(name_for_export(folder.path("a.lcm"), ".mp4"), folder.path("a.mp4"));
  put("a.mp4");
  EXPECT_EQ(name_for_export(folder.path("a.lcm"), ".mp4"), folder.path("a-2.mp4"));
}

}  // namespace
}  // namespace dance
