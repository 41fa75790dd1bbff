// Tones for tactors, on a sound server with a sink that goes nowhere and is listened to.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "core/net/mono_clock.h"
#include "haptics/sound/sound_output.h"
#include "tests/apps/sound_server.h"
#include "tests/haptics/haptic_notes.h"

namespace dance {
namespace {

TEST(HapticSound, IsHeardOnItsSinkOnceForEachOrder) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "pulseaudio is not installed";
  const TestFolder folder("haptic-sound");
  SoundServer server(folder);
  ASSERT_TRUE(server.is_open());
  ASSERT_TRUE(server.listen());
  EXPECT_FALSE(SoundOutput::open("no-such-sink"));
  auto output = SoundOutput::open("dance");
  ASSERT_TRUE(output) << output.error().what;
  const auto clicks_come = [&](std::size_t count) {
    return wait_for([&] {
      server.work();
      return server.clicks().size() >= count;
    });
  };
  for (std::size_t i = 1; i <= 3; ++i) {
    ASSERT_TRUE((*output)->play(some_haptic(mono_now()), mono_now()));
    ASSERT_TRUE(clicks_come(i)) << i;
    // The next tone is another one only after some silence.
    const MonoTime played = mono_now();
    while (mono_now() - played < Duration::ms(400)) {
      server.work();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  EXPECT_GT((*output)->latency(), Duration());
  EXPECT_LT((*output)->latency(), Duration::s(1));
  (*output)->stop();
  EXPECT_EQ(server.clicks().size(), 3u);
}

TEST(HapticSound, AServerThatEndsIsFoundAgain) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "pulseaudio is not installed";
  const TestFolder folder("haptic-sound-again");
  auto server = std::make_unique<SoundServer>(folder);
  ASSERT_TRUE(server->is_open());
  auto output = SoundOutput::open("dance");
  ASSERT_TRUE(output) << output.error().what;
  const auto plays = [&] { return (*output)->play(some_haptic(mono_now()), mono_now()); };
  EXPECT_TRUE(plays());
  server.reset();
  EXPECT_TRUE(wait_for([&] { return !plays(); }));
  EXPECT_FALSE((*output)->is_there());
  EXPECT_NE((*output)->summary().find("lost 1 times"), std::string::npos);
  server = std::make_unique<SoundServer>(folder);
  ASSERT_TRUE(server->is_open());
  EXPECT_TRUE(wait_for(plays));
  EXPECT_TRUE((*output)->is_there());
}

// Accepts, and never answers.
TEST(HapticSound, AServerThatSaysNothingIsGivenUp) {
  const TestFolder folder("haptic-sound-silent");
  const std::string path = folder.path("silent");
  sockaddr_un at{};
  at.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof at.sun_path);
  std::memcpy(at.sun_path, path.c_str(), path.size());
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  ASSERT_EQ(listen(fd, 4), 0);
  setenv("PULSE_SERVER", ("unix:" + path).c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  const auto output = SoundOutput::open("");
  close(fd);
  ASSERT_FALSE(output);
  EXPECT_NE(output.error().what.find("does not answer"), std::string::npos) << output.error().what;
}

TEST(HapticSound, WithoutAServerThereIsOneLine) {
  setenv("PULSE_SERVER", "unix:/no/such/socket", 1);  // NOLINT(concurrency-mt-unsafe)
  const auto output = SoundOutput::open("");
  ASSERT_FALSE(output);
  EXPECT_NE(output.error().what.find("PulseAudio"), std::string::npos);
}

}  // namespace
}  // namespace dance
