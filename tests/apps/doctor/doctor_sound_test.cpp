// The doctor on machines without sound: no server at the socket, one that refuses, one that hangs,
// one without a loudspeaker.
#include "apps/doctor/doctor_sound.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "core/program/child_process.h"
#include "core/sound/microphone.h"
#include "tests/apps/run_program.h"
#include "tests/apps/sound_server.h"

namespace dance {
namespace {

class DoctorSound : public ::testing::Test {
 protected:
  void SetUp() override {
    // NOLINTBEGIN(concurrency-mt-unsafe): one thread
    ::setenv("HOME", folder_.path().c_str(), 1);
    ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    ::unsetenv("PULSE_RUNTIME_PATH");
    ::unsetenv("PULSE_SERVER");
    // NOLINTEND(concurrency-mt-unsafe)
    std::filesystem::create_directories(folder_.path("pulse"));
    std::filesystem::permissions(folder_.path("pulse"), std::filesystem::perms::owner_all);
  }
  SoundFailure failure() {
    const auto found = find_loudspeaker();
    EXPECT_FALSE(found) << "a loudspeaker where none is";
    const SoundFailure failure = found ? SoundFailure() : found.error();
    const Finding finding = check_loudspeaker(found);
    EXPECT_EQ(finding.grade, Finding::Grade::kNote);
    EXPECT_FALSE(finding.what.empty());
    EXPECT_FALSE(finding.cure.empty());
    return failure;
  }

  TestFolder folder_{"doctor-sound"};
};

TEST_F(DoctorSound, LooksWhereThisUsersProgramsFindTheServer) {
  EXPECT_EQ(sound_server_place(), folder_.path("pulse/native"));
  ::setenv("PULSE_RUNTIME_PATH", "/elsewhere", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  EXPECT_EQ(sound_server_place(), "/elsewhere/native");
  ::setenv("PULSE_SERVER", "unix:/named", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  EXPECT_EQ(sound_server_place(), "/named");
  ::setenv("PULSE_SERVER", "studio", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  EXPECT_EQ(sound_server_place(), "studio");
}

TEST_F(DoctorSound, TellsThatNobodyIsThere) {
  const SoundFailure none = failure();
  EXPECT_EQ(none.trouble, SoundTrouble::kNoServer) << none.reason;
  EXPECT_EQ(none.socket, folder_.path("pulse/native"));
  EXPECT_FALSE(none.is_named);
  const std::string elsewhere = folder_.path("nobody");
  ::setenv("PULSE_SERVER", ("unix:" + elsewhere).c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  const SoundFailure named = failure();
  EXPECT_EQ(named.trouble, SoundTrouble::kNoServer) << named.reason;
  EXPECT_EQ(named.socket, elsewhere);
  EXPECT_TRUE(named.is_named);
}

// Opens a socket that listens at a path; -1 if that fails.
int listen_at(const std::string& path) {
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return -1;
  std::memcpy(address.sun_path, path.data(), path.size());
  const bool is_bound = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  return is_bound && listen(fd, 8) == 0 ? fd : -1;
}

TEST_F(DoctorSound, ReportsAServerThatRefusesThisUser) {
  const int fd = listen_at(folder_.path("pulse/native"));
  ASSERT_GE(fd, 0);
  auto refuser = ChildProcess::start_copy([fd] {
    for (;;) close(accept(fd, nullptr, nullptr));
    return 0;
  });
  ASSERT_TRUE(refuser) << refuser.error().what;
  EXPECT_EQ(failure().trouble, SoundTrouble::kRefused);
  refuser->kill_now();
  close(fd);
  EXPECT_EQ(failure().trouble, SoundTrouble::kNoServer) << "what is left of a server is none";
}

TEST_F(DoctorSound, DistinguishesAServerThatHangsFromOneThatRefuses) {
  const int fd = listen_at(folder_.path("pulse/native"));
  ASSERT_GE(fd, 0);
  const SoundFailure hangs = failure();
  EXPECT_EQ(hangs.trouble, SoundTrouble::kHangs) << hangs.reason;
  const auto microphone = default_microphone("test");
  ASSERT_FALSE(microphone);
  EXPECT_NE(microphone.error().what.find("the sound server does not answer; restart it"),
            std::string::npos)
      << microphone.error().what;
  close(fd);
}

TEST_F(DoctorSound, ReportsAServerThatStoppedAnswering) {
  if (!std::filesystem::exists("/usr/bin/pulseaudio"))
    GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  SoundServer sound(folder_);
  ASSERT_TRUE(sound.is_open());
  sound.suspend();
  EXPECT_EQ(failure().trouble, SoundTrouble::kHangs);
  sound.resume();
}

TEST_F(DoctorSound, TellsThatTheServerHasNoLoudspeaker) {
  if (!std::filesystem::exists("/usr/bin/pulseaudio"))
    GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  auto server = ChildProcess::start(
      {"/usr/bin/pulseaudio",
       {"-n", "--exit-idle-time=-1", "--disable-shm=true", "-L",
        "module-native-protocol-unix socket=" + folder_.path("pulse/native") + " auth-anonymous=1"},
       folder_.path("output"),
       folder_.path("talk")});
  ASSERT_TRUE(server) << server.error().what;
  SoundFailure last;
  EXPECT_TRUE(wait_for([&] {
    last = failure();
    return last.trouble == SoundTrouble::kNoLoudspeaker;
  })) << static_cast<int>(last.trouble)
      << last.reason << text_of(folder_.path("talk"));
  EXPECT_FALSE(last.reason.empty());
  server->stop(Duration::s(5));
}

}  // namespace
}  // namespace dance
