#include "core/program/part_file.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "tests/test_folder.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

void write(const std::string& path, const char* text) { std::ofstream(path) << text; }

class PartFileTest : public testing::Test {
 protected:
  TestFolder folder_{"part-file"};
  std::string to_ = folder_.path("a.lcm");
  std::string beside_ = folder_.path("a.lcm.part");
};

TEST_F(PartFileTest, BecomesTheFileWhenItIsKeptAndIsGoneElse) {
  {
    const auto part = PartFile::create(to_);
    ASSERT_TRUE(part.has_value()) << part.error().what;
    EXPECT_EQ((*part)->path(), beside_);
    EXPECT_TRUE(fs::exists(beside_));
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  {
    const auto part = PartFile::create(to_);
    ASSERT_TRUE(part.has_value()) << part.error().what;
    write(beside_, "a dance");
    ASSERT_TRUE((*part)->keep().has_value());
  }
  EXPECT_EQ(text_of(to_), "a dance");
  EXPECT_FALSE(fs::exists(beside_));
}

TEST_F(PartFileTest, LeavesFilesOfOthersAsTheyAre) {
  write(beside_, "a part of others");
  const auto refused = PartFile::create(to_);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().what, beside_ + ": is there already; remove it or choose another name");
  EXPECT_EQ(text_of(beside_), "a part of others");
  fs::remove(beside_);
  fs::create_symlink("nowhere", to_);
  EXPECT_FALSE(PartFile::create(to_).has_value());
  EXPECT_FALSE(fs::exists(beside_));
}

TEST_F(PartFileTest, DoesNotReplaceAFileThatCameWhileItWasWritten) {
  {
    const auto part = PartFile::create(to_);
    ASSERT_TRUE(part.has_value()) << part.error().what;
    write(to_, "a year of dancing");
    const auto kept = (*part)->keep();
    ASSERT_FALSE(kept.has_value());
    EXPECT_EQ(kept.error().what, to_ + ": is there already; remove it or choose another name");
  }
  EXPECT_EQ(text_of(to_), "a year of dancing");
  EXPECT_FALSE(fs::exists(beside_));
}

TEST_F(PartFileTest, IsRemovedWhenASignalEndsTheProgram) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(
        {
          const auto part = PartFile::create(to_);
          std::fputs(part && fs::exists(beside_) ? "it was there" : "it was not there", stderr);
          std::raise(signal);
        },
        testing::KilledBySignal(signal), "it was there");
    EXPECT_TRUE(fs::is_empty(folder_.path())) << signal;
  }
}

}  // namespace
}  // namespace dance
