// Haptics that a house runs as a program of its own, which ends and is started again.
#include <signal.h>

#include <filesystem>

#include "core/net/local_address.h"
#include "core/program/child_process.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

using HouseHaptics = BusPrograms;

// By the socket where it is told things, "haptics-alice-01234567.PID", which one that was killed
// leaves behind.
pid_t running_haptics(pid_t other_than) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(local_socket_folder(), error)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with("haptics-alice-")) continue;
    const long number = std::stol(name.substr(name.rfind('.') + 1));
    if (number > 0 && number < (1L << 32) && number != other_than &&
        send_signal(static_cast<pid_t>(number), 0))
      return static_cast<pid_t>(number);
  }
  return 0;
}

TEST_F(HouseHaptics, ExactHapticsKeepTheirSettingsAfterARestart) {
  ::setenv("XDG_RUNTIME_DIR", folder_.path("").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  std::ofstream(folder_.path("exact.toml"))
      << "[house]\nbus = \"" << kBus << "\"\nguest = \"alice\"\n"
      << "[[haptics]]\nguest = \"alice\"\nto = \"osc\"\nrealtime = true\n"
      << "address = \"127.0.0.1:9009\"\n";
  start("dance-join", {folder_.path("exact.toml"), "--no-view"});
  const auto talk = [&] { return text_of(folder_.path("talk")); };
  pid_t first = 0;
  ASSERT_TRUE(wait_for([&] { return (first = running_haptics(0)) > 0; })) << talk();
  const std::string set = bin("dance-haptics-set") + " --guest alice --bus " + quoted(kBus);
  ASSERT_EQ(run(set + " --limit 0.5 --off").exit_code, 0) << talk();
  ASSERT_TRUE(wait_for([&] { return talk().find("haptics are off") != std::string::npos; }));
  // Told while it does not run: the more often it has died, the longer that is.
  const auto deaths = [&] {
    const std::string said = talk();
    std::size_t count = 0, at = 0;
    for (; (at = said.find("it is started again", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  for (std::size_t death = 1; death <= 3; ++death) {
    const pid_t running = first;
    ASSERT_TRUE(send_signal(running, SIGKILL));
    ASSERT_TRUE(wait_for([&] { return deaths() == death; })) << talk();
    if (death == 3) break;
    ASSERT_TRUE(wait_for([&] { return (first = running_haptics(running)) > 0; })) << talk();
  }
  ASSERT_EQ(run(set + " --limit 0.25").exit_code, 0) << talk();
  pid_t second = 0;
  ASSERT_TRUE(wait_for([&] { return (second = running_haptics(first)) > 0; })) << talk();
  std::string words = text_of("/proc/" + std::to_string(second) + "/cmdline");
  std::replace(words.begin(), words.end(), '\0', ' ');
  EXPECT_NE(words.find(" --off "), std::string::npos) << words;
  EXPECT_NE(words.find(" --limit=0.2500 "), std::string::npos) << words;
  EXPECT_TRUE(wait_for([&] { return talk().find("alice works again") != std::string::npos; }))
      << talk();
}

}  // namespace
}  // namespace dance
