// dance key at a terminal, as a user pastes a line into it, and as she thinks better of it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <optional>

#include "core/program/child_process.h"
#include "tests/apps/run_program.h"
#include "tunnel/seal/keys/identity_key.h"

namespace dance {
namespace {

class KeyAtATerminal : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::openpty(&user_, &terminal_, nullptr, nullptr, nullptr) != 0)
      GTEST_SKIP() << "no pseudo-terminal can be had here; is /dev/pts mounted?";
    // The program gets the terminal as its own, and neither end as a further descriptor.
    for (const int fd : {user_, terminal_}) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
  }
  void TearDown() override {
    child_.reset();
    if (user_ >= 0) ::close(user_);
    if (terminal_ >= 0) ::close(terminal_);
  }

  // Starts the program and waits until it does not show what is typed. The terminal outlives the
  // program, as its shell would hold it.
  void start_unseen() {
    before_ = modes();
    ASSERT_TRUE(shows());
    auto child = ChildProcess::start({.program = bin("dance-key"),
                                      .arguments = {"--file", folder_.path("keys")},
                                      .terminal_fd = terminal_});
    ASSERT_TRUE(child) << child.error().what;
    child_ = std::move(*child);
    ASSERT_TRUE(wait_for([&] { return !shows(); })) << heard_;
  }

  termios modes() const {
    termios now{};
    EXPECT_EQ(::tcgetattr(terminal_, &now), 0);
    return now;
  }
  bool shows() const { return (modes().c_lflag & ECHO) != 0; }
  void expect_as_before() const {
    const termios now = modes();
    EXPECT_EQ(now.c_lflag, before_.c_lflag);
    EXPECT_EQ(now.c_iflag, before_.c_iflag);
    EXPECT_EQ(now.c_oflag, before_.c_oflag);
    for (int i = 0; i < NCCS; ++i) EXPECT_EQ(now.c_cc[i], before_.c_cc[i]) << i;
  }

  void type(const std::string& text) const {
    EXPECT_EQ(::write(user_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  // What the terminal shows comes to hold a word.
  bool shows_word(const std::string& word) {
    return wait_for([&] {
      std::array<char, 1024> chunk;
      pollfd there{user_, POLLIN, 0};
      while (::poll(&there, 1, 0) > 0 && (there.revents & POLLIN)) {
        const ssize_t n = ::read(user_, chunk.data(), chunk.size());
        if (n <= 0) break;
        heard_.append(chunk.data(), static_cast<std::size_t>(n));
      }
      return heard_.find(word) != std::string::npos;
    });
  }
  void expect_end(int exit_code) {
    ASSERT_TRUE(child_->wait(Duration::s(60))) << "it goes on";
    EXPECT_EQ(child_->exit_code(), exit_code) << child_->exit_text();
  }

  TestFolder folder_{"key-program"};
  std::optional<ChildProcess> child_;
  int user_ = -1;      // who types and reads
  int terminal_ = -1;  // the program's side
  termios before_{};
  std::string heard_;
  const std::string secret_ = PrivateKey::make().text();
  const std::string keys_ = PrivateKey::make().public_key().text() + "." + secret_;
};

TEST_F(KeyAtATerminal, DoesNotShowTheLineAndKeepsIt) {
  start_unseen();
  ASSERT_TRUE(shows_word("not shown")) << heard_;
  type("dance-key:alice@dance.example.org#" + keys_ + "\n");
  expect_end(0);
  ASSERT_TRUE(shows_word("kept in")) << heard_;
  EXPECT_EQ(heard_.find(secret_), std::string::npos) << heard_;
  EXPECT_NE(text_of(folder_.path("keys")).find(secret_), std::string::npos);
  expect_as_before();
}

TEST_F(KeyAtATerminal, CtrlCGivesTheTerminalBackAsItWas) {
  start_unseen();
  type("dance-key:alice\x03");
  expect_end(128 + SIGINT);
  expect_as_before();
  EXPECT_FALSE(std::filesystem::exists(folder_.path("keys")));
}

TEST_F(KeyAtATerminal, CtrlZDoesNotLeaveItHalfWay) {
  start_unseen();
  type("\x1a\x15");  // Ctrl-U: away with the line so far
  type("dance-key:alice#" + keys_ + "\n");
  expect_end(0);
  expect_as_before();
}

TEST_F(KeyAtATerminal, AHangupThatIsIgnoredStaysIgnored) {
  ::signal(SIGHUP, SIG_IGN);
  start_unseen();
  ::signal(SIGHUP, SIG_DFL);
  ASSERT_TRUE(child_ && child_->send_signal(SIGHUP));
  type("dance-key:alice#" + keys_ + "\n");
  expect_end(0);
  expect_as_before();
}

class KeyThatIsEnded : public KeyAtATerminal, public ::testing::WithParamInterface<int> {};

TEST_P(KeyThatIsEnded, GivesTheTerminalBackAsItWas) {
  start_unseen();
  ASSERT_TRUE(child_ && child_->send_signal(GetParam()));
  expect_end(128 + GetParam());
  expect_as_before();
}

INSTANTIATE_TEST_SUITE_P(BySignals, KeyThatIsEnded,
                         ::testing::Values(SIGINT, SIGQUIT, SIGTERM, SIGHUP));

}  // namespace
}  // namespace dance
