// The demo as a user starts it: real programs, two buses, a server, in a network of this test's own.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

namespace {

namespace fs = std::filesystem;

std::string out_folder(const std::string& name) {
  const fs::path folder =
      fs::temp_directory_path() / ("dance-" + name + "-" + std::to_string(getpid()));
  fs::remove_all(folder);
  return folder.string();
}

std::string bin(const std::string& program) { return DANCE_BINARY_DIR "/bin/" + program; }

std::string output_of(const std::string& command, int& status) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> chunk;
  for (std::size_t n; (n = fread(chunk.data(), 1, chunk.size(), pipe)) > 0;)
    text.append(chunk.data(), n);
  status = WEXITSTATUS(pclose(pipe));
  return text;
}

nlohmann::json run_demo(const std::string& options, const std::string& out) {
  int status = 0;
  const std::string text = output_of(
      bin("dance-demo") + " --headless --json --out " + out + " " + options + " 2>/dev/null",
      status);
  auto json = nlohmann::json::parse(text, nullptr, false);
  EXPECT_TRUE(json.is_object()) << text;
  return json;
}

void expect_all_delivered(const nlohmann::json& summary, std::size_t guests,
                          std::int64_t least_sent) {
  ASSERT_EQ(summary["guests"].size(), guests);
  for (const auto& guest : summary["guests"]) {
    EXPECT_GE(guest["sent"].get<std::int64_t>(), least_sent) << guest;
    EXPECT_GE(guest["delivered"].get<double>(), 0.999 * guest["sent"].get<double>()) << guest;
  }
}

// The pid of a child of the demo that was started with this word in its command line.
pid_t find_program(const std::string& word, const std::string& session) {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "cmdline");
    std::stringstream line;
    line << file.rdbuf();
    if (line.str().find(word) != std::string::npos && line.str().find(session) != std::string::npos)
      return static_cast<pid_t>(std::stol(entry.path().filename().string()));
  }
  return 0;
}

TEST(Demo, DeliversACoupleBothWaysOnACleanLine) {
  const std::string out = out_folder("clean");
  const auto summary = run_demo("--seconds 4", out);
  expect_all_delivered(summary, 2, 230);
  EXPECT_TRUE(fs::exists(summary["log"].get<std::string>()));
  fs::remove_all(out);
}

TEST(Demo, AccountsForEveryPoseOfABadLine) {
  const std::string out = out_folder("line");
  const auto summary = run_demo("--seconds 4 --link 'delay=40ms jitter=5ms loss=5% seed=3'", out);
  ASSERT_EQ(summary["guests"].size(), 2u);
  for (const auto& guest : summary["guests"]) {
    std::int64_t lost = 0;
    for (const auto& [cause, count] : guest["lost"].items()) lost += count.get<std::int64_t>();
    EXPECT_EQ(guest["sent"].get<std::int64_t>(), guest["delivered"].get<std::int64_t>() + lost)
        << guest;
    EXPECT_GT(lost, 0) << guest;
    EXPECT_GT(guest["age_p50_ms"].get<double>(), 40.0) << guest;
  }
  fs::remove_all(out);
}

TEST(Demo, GoesOnWhenAHouseAndTheServerAreKilledAndTheyComeBack) {
  const std::string out = out_folder("kill");
  nlohmann::json summary;
  std::thread demo([&] { summary = run_demo("--seconds 9", out); });
  const auto kill_after = [&](int ms, const std::string& word, const std::string& mark) {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
    const pid_t pid = find_program(word, mark);
    EXPECT_GT(pid, 0) << word;
    if (pid > 0) kill(pid, SIGKILL);
  };
  kill_after(4000, "dance-join", out + "/house-b.toml");
  kill_after(2500, "dance-server", "--port");
  demo.join();
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(summary["restarts"].get<int>(), 2);
  for (const auto& guest : summary["guests"]) {
    EXPECT_GE(guest["sent"].get<int>(), 500) << "the others go on: " << guest;
    // Away for half a second each, and back within three.
    EXPECT_GE(guest["delivered"].get<double>(), 0.4 * guest["sent"].get<double>()) << guest;
  }
  fs::remove_all(out);
}

TEST(Demo, RefusesWhatCannotBeInOneLine) {
  for (const auto& [options, word] :
       {std::pair<std::string, std::string>{"--motion /nonexistent.bvh", "nonexistent.bvh"},
        {"--guests 1", "guests"},
        {"--through fly", "fly"},
        {"--nonsense", "nonsense"}}) {
    int status = 0;
    const std::string out = out_folder("wrong");
    const std::string text = output_of(bin("dance-demo") + " --headless --seconds 1 --out " + out +
                                           " " + options + " 2>&1 >/dev/null",
                                       status);
    EXPECT_NE(status, 0) << options;
    EXPECT_NE(text.find(word), std::string::npos) << options << ": " << text;
    fs::remove_all(out);
  }
}

}  // namespace
