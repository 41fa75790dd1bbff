// A Unix socket that tells everybody the same, whatever they do with it.
#include "core/net/local_socket.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

class LocalSocket : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller = std::move(*made);
  }
  void TearDown() override {
    server.reset();
    std::filesystem::remove_all(folder);
  }

  Result<std::unique_ptr<LocalTextServer>> try_open(std::string text = "all is well\n") {
    return LocalTextServer::open(
        path,
        [this, text](MonoTime) {
          ++made_texts;
          return text;
        },
        *poller);
  }
  void open(std::string text = "all is well\n") {
    auto opened = try_open(std::move(text));
    ASSERT_TRUE(opened) << opened.error().what;
    server = std::move(*opened);
  }
  // As a program beside the server asks it.
  tl::expected<std::string, LocalFailure> ask() {
    std::optional<tl::expected<std::string, LocalFailure>> answer;
    std::thread client([&] {
      answer = read_local_text(path, Duration::s(60));
      poller_is_needed = false;
    });
    poller_is_needed = true;
    while (poller_is_needed) poller->run_once(Duration::ms(5));
    client.join();
    return *answer;
  }
  int connect_raw() const {
    const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un to{};
    to.sun_family = AF_UNIX;
    std::strcpy(to.sun_path, path.c_str());  // NOLINT: fits
    EXPECT_EQ(::connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    return fd;
  }
  bool turn_until(const std::function<bool()>& is_so) {
    const MonoTime give_up = mono_now() + Duration::s(200);
    while (!is_so() && mono_now() < give_up) poller->run_once(Duration::ms(5));
    return is_so();
  }
  static unsigned mode_of(const std::string& of) {
    struct stat found {};
    EXPECT_EQ(::stat(of.c_str(), &found), 0);
    return found.st_mode & 0777u;
  }

  const std::string folder =
      (std::filesystem::temp_directory_path() / ("dance-local-" + std::to_string(getpid())))
          .string();
  const std::string path = folder + "/mine/some.sock";
  std::unique_ptr<Poller> poller;
  std::unique_ptr<LocalTextServer> server;
  int made_texts = 0;
  std::atomic<bool> poller_is_needed{false};
};

TEST_F(LocalSocket, AnswersEachClientOfThisUserOnly) {
  open();
  const auto answer = ask();
  ASSERT_TRUE(answer) << answer.error().reason;
  EXPECT_EQ(*answer, "all is well\n");
  EXPECT_EQ(server->counters().answered, 1u);
  EXPECT_EQ(mode_of(folder + "/mine"), 0700u);
  EXPECT_EQ(mode_of(path), 0600u);
  server.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(read_local_text(path, Duration::s(1)).error().trouble, LocalTrouble::kNobody);
}

TEST_F(LocalSocket, ATextLongerThanTheSystemsBufferComesWhole) {
  std::string text(5'000'000, 'x');
  for (std::size_t i = 0; i < text.size(); i += 7) text[i] = static_cast<char>('a' + i % 26);
  open(text);
  const auto answer = ask();
  ASSERT_TRUE(answer) << answer.error().reason;
  EXPECT_EQ(*answer, text);
}

TEST_F(LocalSocket, WhoDoesNotReadIsDroppedAndHoldsUpNobody) {
  open(std::string(5'000'000, 'x'));
  const int idle = connect_raw();
  ASSERT_TRUE(turn_until([&] { return server->client_count() == 1; }));
  EXPECT_TRUE(ask()) << "another is answered meanwhile";
  EXPECT_TRUE(turn_until([&] { return server->counters().dropped == 1; }));
  EXPECT_EQ(server->client_count(), 0u);
  ::close(idle);
  const int gone = connect_raw();
  ::close(gone);
  EXPECT_TRUE(turn_until([&] { return server->counters().dropped == 2; })) << "nor a signal";
}

TEST_F(LocalSocket, AsManyAsItLikesAndNoMore) {
  open(std::string(5'000'000, 'x'));
  // They wait in the socket's queue, and come in together.
  std::vector<int> idle;
  for (std::size_t i = 0; i < LocalTextServer::kMaxClients + 1; ++i) idle.push_back(connect_raw());
  ASSERT_TRUE(turn_until([&] { return server->counters().dropped == 1; }));
  EXPECT_EQ(server->client_count(), LocalTextServer::kMaxClients);
  EXPECT_EQ(made_texts, 1) << "the text is not made for each";
  char byte = 0;
  EXPECT_EQ(::recv(idle.back(), &byte, 1, 0), 0) << "the one too many is told so at once";
  for (const int fd : idle) ::close(fd);
}

TEST_F(LocalSocket, WithoutAFreeDescriptorItTriesAgainLater) {
  open();
  const int client = connect_raw();
  // No number below the limit is free: this one was, and is the lowest that is.
  const int lowest = ::dup(0);
  ASSERT_GE(lowest, 0);
  ::close(lowest);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit none = before;
  none.rlim_cur = static_cast<rlim_t>(lowest);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  int turns = 0;
  const MonoTime end = mono_now() + Duration::ms(200);
  for (; mono_now() < end; ++turns) poller->run_once(Duration::ms(50));
  EXPECT_LT(turns, 20) << "it does not go round and round meanwhile";
  EXPECT_EQ(made_texts, 0);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_TRUE(turn_until([&] { return server->counters().answered == 1; }));
  ::close(client);
}

TEST_F(LocalSocket, TakesThePlaceOfADeadSocketButNotOfALivingOne) {
  open();
  const auto second = try_open();
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("another server's"), std::string::npos);
  EXPECT_TRUE(ask()) << "and the first is still there";
  server.reset();
  // What a server that was killed leaves behind.
  const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un at{};
  at.sun_family = AF_UNIX;
  std::strcpy(at.sun_path, path.c_str());  // NOLINT: fits
  ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  ::close(fd);
  ASSERT_TRUE(std::filesystem::exists(path));
  EXPECT_EQ(read_local_text(path, Duration::s(1)).error().trouble, LocalTrouble::kNobody);
  open();
  EXPECT_TRUE(ask());
}

TEST_F(LocalSocket, TakesNoFolderThatIsNotItsOwn) {
  std::filesystem::create_directories(folder + "/elsewhere");
  std::filesystem::create_symlink(folder + "/elsewhere", folder + "/mine");
  auto refused = try_open();
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("not this user's folder"), std::string::npos);
  std::filesystem::remove(folder + "/mine");
  std::ofstream(folder + "/mine") << "a file";
  EXPECT_FALSE(try_open());
  std::filesystem::remove(folder + "/mine");
  // Ours, but open to others: it is closed.
  std::filesystem::create_directories(folder + "/mine");
  ::chmod((folder + "/mine").c_str(), 0755);
  open();
  EXPECT_EQ(mode_of(folder + "/mine"), 0700u);
}

TEST_F(LocalSocket, AFileInItsPlaceIsNotRemoved) {
  std::filesystem::create_directories(folder + "/mine");
  std::ofstream(path) << "precious";
  EXPECT_FALSE(try_open());
  EXPECT_EQ(std::filesystem::file_size(path), 8u);
}

TEST_F(LocalSocket, APathThatIsTooLongIsNamed) {
  const std::string longer = folder + "/" + std::string(120, 'x');
  const auto answer = read_local_text(longer, Duration::s(1));
  ASSERT_FALSE(answer);
  EXPECT_NE(answer.error().reason.find("XDG_RUNTIME_DIR"), std::string::npos);
}

TEST_F(LocalSocket, ASilentServerIsWaitedForNoLongerThanSaid) {
  open();  // but nobody turns its poller
  const auto answer = read_local_text(path, Duration::ms(50));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().trouble, LocalTrouble::kSilent);
}

TEST_F(LocalSocket, TheFolderIsThatOfTheSession) {
  ::setenv("XDG_RUNTIME_DIR", "/run/user/7", 1);
  EXPECT_EQ(local_socket_folder(), "/run/user/7/dance");
  ::unsetenv("XDG_RUNTIME_DIR");
  EXPECT_EQ(local_socket_folder(), "/tmp/dance-" + std::to_string(geteuid()));
  ::setenv("XDG_RUNTIME_DIR", "not/absolute", 1);
  EXPECT_EQ(local_socket_folder(), "/tmp/dance-" + std::to_string(geteuid()));
  ::unsetenv("XDG_RUNTIME_DIR");
}

}  // namespace
}  // namespace dance
