// Whatever way a program creates a file, only its user can read it.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdio>

#include "core/program/child_process.h"
#include "core/program/part_file.h"
#include "core/program/program.h"
#include "core/program/whole_file.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

class PrivateFiles : public ::testing::Test {
 protected:
  void SetUp() override { ::umask(0022); }
  void TearDown() override { ::umask(before_); }
  void run_as_program(const std::string& name_of_program, const std::function<void()>& body) {
    CommandLine line("", name_of_program);
    std::string name = "test";
    char* words = name.data();
    EXPECT_EQ(run_program(line, 1, &words,
                          [&]() -> Result<void> {
                            body();
                            return {};
                          }),
              0);
  }
  std::string path(const std::string& name) const { return folder_.path(name); }

  TestFolder folder_{"private-files"};
  const mode_t before_ = ::umask(0022);
};

TEST_F(PrivateFiles, AreMadeByEveryWayThatOurProgramsUse) {
  run_as_program("dance files", [this] {
    std::ofstream(path("stream")) << "x";
    if (std::FILE* file = std::fopen(path("stdio").c_str(), "wx")) std::fclose(file);
    EXPECT_TRUE(write_whole_file(path("whole"), "x"));
    const auto part = PartFile::create(path("part"));
    ASSERT_TRUE(part) << part.error().what;
    EXPECT_TRUE(is_private(path("part.part")));
    EXPECT_TRUE((*part)->keep());
    std::filesystem::create_directories(path("folder/inner"));
    auto child = ChildProcess::start(
        {"/bin/sh", {"-c", "echo x >" + path("of-child")}, path("output"), path("talk")});
    ASSERT_TRUE(child) << child.error().what;
    EXPECT_TRUE(child->wait(Duration::s(60)));
  });
  for (const char* name :
       {"stream", "stdio", "whole", "part", "folder", "folder/inner", "of-child", "output", "talk"})
    EXPECT_TRUE(is_private(path(name))) << name;
}

TEST_F(PrivateFiles, AFileThatIsThereKeepsTheModeThatItsUserGaveIt) {
  std::ofstream(path("shared")) << "x";
  ASSERT_EQ(::chmod(path("shared").c_str(), 0644), 0);
  run_as_program("dance file", [this] { EXPECT_TRUE(write_whole_file(path("shared"), "y")); });
  EXPECT_EQ(text_of(path("shared")), "y");
  struct stat about {};
  ASSERT_EQ(::stat(path("shared").c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777u, 0644u);
}

}  // namespace
}  // namespace dance
