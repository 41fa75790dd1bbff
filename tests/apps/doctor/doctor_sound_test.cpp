// The doctor before machines without sound: nobody at the socket, somebody who says nothing, a
// server without a loudspeaker.
#include "apps/doctor/doctor_sound.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "core/program/child_process.h"
#include "tests/apps/run_program.h"

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

TEST_F(DoctorSound, TellsThatWhoIsThereDoesNotLetUsIn) {
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = folder_.path("pulse/native");
  ASSERT_LT(path.size(), sizeof address.sun_path);
  std::memcpy(address.sun_path, path.data(), path.size());
  ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(fd, 8), 0);
  EXPECT_EQ(failure().trouble, SoundTrouble::kRefused);
  close(fd);
  EXPECT_EQ(failure().trouble, SoundTrouble::kNoServer) << "what is left of a server is none";
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
