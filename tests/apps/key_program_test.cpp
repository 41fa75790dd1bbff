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

#include "tests/apps/run_program.h"
#include "tunnel/seal/preshared_key.h"

namespace dance {
namespace {

class KeyAtATerminal : public ::testing::Test {
 protected:
  void TearDown() override {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
    if (user_ >= 0) ::close(user_);
    if (terminal_ >= 0) ::close(terminal_);
  }

  // Starts the program and waits until it does not show what is typed.
  void start_unseen(bool ignores_hangup = false) {
    // The terminal outlives the program, as its shell would hold it.
    std::array<char, 128> name{};
    const std::string program = bin("dance-key"), file = folder_.path("keys");
    child_ = ::forkpty(&user_, name.data(), nullptr, nullptr);
    ASSERT_GE(child_, 0);
    if (child_ == 0) {
      if (ignores_hangup) ::signal(SIGHUP, SIG_IGN);
      // Until the parent has seen the terminal as it is before.
      ::raise(SIGSTOP);
      ::execl(program.c_str(), program.c_str(), "--file", file.c_str(), nullptr);
      ::_exit(127);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child_, &status, WUNTRACED), child_);
    ASSERT_TRUE(WIFSTOPPED(status));
    terminal_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    ASSERT_GE(terminal_, 0);
    before_ = modes();
    ASSERT_TRUE(shows());
    ASSERT_EQ(::kill(child_, SIGCONT), 0);
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
  // How it ended, once it has; nullopt if it never does.
  std::optional<int> end_status() {
    int status = 0;
    if (!wait_for([&] { return ::waitpid(child_, &status, WNOHANG) == child_; }))
      return std::nullopt;
    child_ = -1;
    return status;
  }
  void expect_end(int exit_code) {
    const auto status = end_status();
    ASSERT_TRUE(status) << "it goes on";
    EXPECT_TRUE(WIFEXITED(*status)) << *status;
    EXPECT_EQ(WEXITSTATUS(*status), exit_code);
  }

  TestFolder folder_{"key-program"};
  pid_t child_ = -1;
  int user_ = -1;      // who types and reads
  int terminal_ = -1;  // the program's side
  termios before_{};
  std::string heard_;
  const std::string secret_ = PresharedKey::make().text();
};

TEST_F(KeyAtATerminal, DoesNotShowTheLineAndKeepsIt) {
  start_unseen();
  ASSERT_TRUE(shows_word("not shown")) << heard_;
  type("dance-key:alice@dance.example.org#" + secret_ + "\n");
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
  type("dance-key:alice#" + secret_ + "\n");
  expect_end(0);
  expect_as_before();
}

TEST_F(KeyAtATerminal, AHangupThatIsIgnoredStaysIgnored) {
  start_unseen(true);
  ASSERT_EQ(::kill(child_, SIGHUP), 0);
  type("dance-key:alice#" + secret_ + "\n");
  expect_end(0);
  expect_as_before();
}

class KeyThatIsEnded : public KeyAtATerminal, public ::testing::WithParamInterface<int> {};

TEST_P(KeyThatIsEnded, GivesTheTerminalBackAsItWas) {
  start_unseen();
  ASSERT_EQ(::kill(child_, GetParam()), 0);
  expect_end(128 + GetParam());
  expect_as_before();
}

INSTANTIATE_TEST_SUITE_P(BySignals, KeyThatIsEnded,
                         ::testing::Values(SIGINT, SIGQUIT, SIGTERM, SIGHUP));

}  // namespace
}  // namespace dance
