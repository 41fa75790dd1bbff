#include "core/program/standard_output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "core/program/child_process.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

// Writes in a child whose stdout is `fd`; the exit code is 0 where it was written, 1 where the
// error names the cause.
int exit_code_of_write_to(int fd, const char* cause) {
  auto child = ChildProcess::start_copy([&] {
    dup2(fd, STDOUT_FILENO);
    const auto written = write_to_stdout("a secret\n");
    if (written) return 0;
    return written.error().what.find(cause) != std::string::npos ? 1 : 2;
  });
  EXPECT_TRUE(child && child->wait(Duration::s(60)));
  return child ? child->exit_code() : -1;
}

TEST(StandardOutput, ReportsAFullDevice) {
  const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  EXPECT_EQ(exit_code_of_write_to(full, "No space left on device"), 1);
  close(full);
}

TEST(StandardOutput, ReportsAPipeWithoutAReader) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  close(ends[0]);
  EXPECT_EQ(exit_code_of_write_to(ends[1], "Broken pipe"), 1);
  close(ends[1]);
}

TEST(StandardOutput, WritesTheTextToTheByte) {
  const TestFolder folder("standard-output");
  const int file = open(folder.path("out").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_GE(file, 0);
  EXPECT_EQ(exit_code_of_write_to(file, ""), 0);
  close(file);
  EXPECT_EQ(text_of(folder.path("out")), "a secret\n");
}

}  // namespace
}  // namespace dance
