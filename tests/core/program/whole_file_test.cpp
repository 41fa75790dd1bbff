#include "core/program/whole_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

TEST(WholeFile, IsThereOrAsItWas) {
  const TestFolder folder("whole-file");
  const std::string path = folder.path("a.model");
  for (const char* text : {"first", "second, and longer", ""}) {
    ASSERT_TRUE(write_whole_file(path, text));
    EXPECT_EQ(text_of(path), text);
  }
  ASSERT_TRUE(write_whole_file(path, "kept"));
  fs::create_directory(folder.path("b.model"));
  const auto refused = write_whole_file(folder.path("b.model"), "is a folder");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("b.model cannot be written: "), std::string::npos);
  EXPECT_FALSE(write_whole_file(folder.path("none/c.model"), "no such folder"));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path(""))) ++files;
  EXPECT_EQ(files, 2u) << "nothing is left beside them";
}

TEST(WholeFile, IsTriedWithoutATrace) {
  const TestFolder folder("whole-file");
  ASSERT_TRUE(write_whole_file(folder.path("a.model"), "kept"));
  fs::create_directory(folder.path("b.model"));
  EXPECT_TRUE(try_whole_file(folder.path("a.model")));
  EXPECT_TRUE(try_whole_file(folder.path("new.model")));
  EXPECT_TRUE(try_whole_file("/dev/null"));
  for (const char* bad : {"b.model", "none/c.model"}) {
    const auto refused = try_whole_file(folder.path(bad));
    ASSERT_FALSE(refused) << bad;
    EXPECT_NE(refused.error().what.find(std::string(bad) + " cannot be written: "),
              std::string::npos);
  }
  EXPECT_EQ(text_of(folder.path("a.model")), "kept");
  EXPECT_FALSE(fs::exists(folder.path("new.model")));
}

TEST(WholeFile, GoesWhereALinkLeads) {
  const TestFolder folder("whole-file");
  ASSERT_TRUE(write_whole_file(folder.path("old"), "old"));
  fs::create_symlink(folder.path("old"), folder.path("link"));
  ASSERT_TRUE(write_whole_file(folder.path("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(folder.path("link")));
  EXPECT_EQ(text_of(folder.path("old")), "new");
  fs::create_symlink("not-yet", folder.path("ahead"));
  ASSERT_TRUE(write_whole_file(folder.path("ahead"), "now"));
  EXPECT_TRUE(fs::is_symlink(folder.path("ahead")));
  EXPECT_EQ(text_of(folder.path("not-yet")), "now");
}

TEST(WholeFile, StaysAsPrivateAsItWas) {
  const TestFolder folder("whole-file");
  ASSERT_TRUE(write_whole_file(folder.path("key"), "old"));
  fs::permissions(folder.path("key"), fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(write_whole_file(folder.path("key"), "new"));
  EXPECT_EQ(fs::status(folder.path("key")).permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST(WholeFile, TakesNoDevicesPlace) {
  const TestFolder folder("whole-file");
  fs::create_symlink("/dev/null", folder.path("nowhere"));
  EXPECT_TRUE(write_whole_file(folder.path("nowhere"), "gone"));
  EXPECT_TRUE(fs::is_character_file(folder.path("nowhere")));
  fs::create_symlink("/dev/full", folder.path("full"));
  const auto refused = write_whole_file(folder.path("full"), "too much");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("No space left"), std::string::npos) << refused.error().what;
}

TEST(WholeFile, IsReadUpToABoundAndOnlyWhereItIsAFile) {
  const TestFolder folder("whole-file-read");
  const std::string path = folder.path("a");
  EXPECT_EQ(read_whole_file(path, 10).error().what, path + ": no such file");
  ASSERT_TRUE(write_whole_file(path, "0123456789"));
  EXPECT_EQ(read_whole_file(path, 10), "0123456789");
  EXPECT_EQ(read_whole_file(path, 9).error().what, path + ": larger than 0 MiB");
  EXPECT_EQ(read_whole_file(folder.path(), 10).error().what,
            folder.path() + ": a folder; name a file in it");
  EXPECT_EQ(read_whole_file("/dev/null", 10).error().what, "/dev/null: no regular file");
}

}  // namespace
}  // namespace dance
