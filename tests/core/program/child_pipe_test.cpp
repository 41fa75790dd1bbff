#include "core/program/child_pipe.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <thread>

#include "core/program/child_process.h"
#include "core/program/talk.h"

namespace dance {
namespace {

TEST(ChildPipe, HasAllThatAProgramWroteAndThenItsEnd) {
  auto pipe = ChildPipe::open();
  ASSERT_TRUE(pipe) << pipe.error().what;
  std::array<char, 7> some;
  EXPECT_EQ(pipe->read(some), 0u) << "nothing has come, and nobody waits";
  ChildProcess::Options how{"/bin/sh", {"-c", "echo well; echo danced"}, "", ""};
  how.output_fd = pipe->child_fd();
  auto program = ChildProcess::start(how);
  ASSERT_TRUE(program) << program.error().what;
  pipe->let_go();
  std::string said;
  while (const auto count = pipe->read(some)) {
    said.append(some.data(), *count);
    if (*count == 0) std::this_thread::yield();
  }
  EXPECT_EQ(said, "well\ndanced\n");
  EXPECT_TRUE(pipe->is_open()) << "its owner closes it";
  pipe->close();
  EXPECT_FALSE(pipe->is_open());
  EXPECT_FALSE(pipe->read(some));
}

TEST(ChildPipe, IsMovedWithBothEnds) {
  auto opened = ChildPipe::open();
  ASSERT_TRUE(opened);
  const int fd = opened->fd(), child_fd = opened->child_fd();
  ChildPipe pipe = std::move(*opened);
  EXPECT_FALSE(opened->is_open());
  EXPECT_EQ(pipe.fd(), fd);
  EXPECT_EQ(pipe.child_fd(), child_fd);
}

TEST(Talk, LinesAreReadWithoutTheirTime) {
  EXPECT_EQ(talk::without_time("12:34:56.789 dance join: hello"), "dance join: hello");
  for (const char* other : {"", "12:34:56.789", "12-34-56.789 x", "1a:34:56.789 x", "hello"})
    EXPECT_EQ(talk::without_time(other), other);
}

}  // namespace
}  // namespace dance
