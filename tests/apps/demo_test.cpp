// The demo as a user starts it: real programs, two buses, a server, in a network of this test's
// own.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/program/child_process.h"
#include "formats/log/log_file.h"
#include "house/session.h"
#include "tests/apps/run_program.h"

namespace {

namespace fs = std::filesystem;
using dance::bin;
using dance::Finished;
using dance::TestFolder;
using dance::wait_for;

nlohmann::json run_demo(const std::string& options, const std::string& out) {
  const Finished demo =
      dance::run(bin("dance-demo") + " --headless --json --out " + out + " " + options);
  auto json = nlohmann::json::parse(demo.output, nullptr, false);
  EXPECT_TRUE(json.is_object()) << demo.output << demo.talk;
  return json;
}

// How many poses are sent, and how many of them a program that had to wait found overtaken by newer
// ones, depends on how busy the machine is. Each one is accounted for, and dancers arrive;
// docs/latency.md has the command that measures.
void expect_all_delivered(const nlohmann::json& summary, std::size_t guests) {
  ASSERT_EQ(summary["guests"].size(), guests);
  for (const auto& guest : summary["guests"]) {
    const auto sent = guest["sent"].get<std::int64_t>();
    const auto delivered = guest["delivered"].get<std::int64_t>();
    std::int64_t lost = 0;
    for (const auto& [cause, count] : guest["lost"].items()) lost += count.get<std::int64_t>();
    EXPECT_GT(sent, 0) << guest;
    EXPECT_EQ(delivered + lost, sent) << guest;
    EXPECT_GE(10 * delivered, sent) << guest;
  }
}

// Empty where the process has ended; getline, as a stream's iterators throw then.
std::string command_line_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/cmdline");
  std::string line;
  std::getline(file, line);
  std::replace(line.begin(), line.end(), '\0', ' ');
  return line;
}

pid_t parent_of(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("PPid:")) return static_cast<pid_t>(std::strtol(&line[5], nullptr, 10));
  return 0;
}

// A demo of this test's own, which ends with it; its programs are its children, whatever else runs
// on this machine.
class RunningDemo {
 public:
  RunningDemo(const std::string& options, const std::string& out)
      : out_(out), thread_([this, options] { summary_ = run_demo(options, out_); }) {}
  ~RunningDemo() { end(); }
  RunningDemo(const RunningDemo&) = delete;
  RunningDemo& operator=(const RunningDemo&) = delete;

  // Of the program with both of these in its command line; 0 where none runs.
  pid_t pid_of(const std::string& program, const std::string& mark) const {
    return find([&](pid_t pid, const std::string& line) {
      return line.find(program) != std::string::npos && line.find(mark) != std::string::npos &&
             is_demo(command_line_of(parent_of(pid)));
    });
  }
  // Asks it to end, if it has not; then its summary.
  const nlohmann::json& end() {
    if (!thread_.joinable()) return summary_;
    const pid_t demo = find([&](pid_t, const std::string& line) { return is_demo(line); });
    dance::send_signal(demo, SIGTERM);
    thread_.join();
    return summary_;
  }

 private:
  template <class Wanted>
  static pid_t find(const Wanted& is_wanted) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/proc", error)) {
      const auto pid =
          static_cast<pid_t>(std::strtol(entry.path().filename().c_str(), nullptr, 10));
      if (pid > 0 && is_wanted(pid, command_line_of(pid))) return pid;
    }
    return 0;
  }
  bool is_demo(const std::string& line) const {
    return line.starts_with(bin("dance-demo") + " ") &&
           line.find(" " + out_ + " ") != std::string::npos;
  }

  std::string out_;
  nlohmann::json summary_;
  std::thread thread_;
};

int count_in_log(const std::string& path, const std::string& channel) {
  auto log = dance::LogReader::open(path);
  int count = 0;
  while (log) {
    const auto event = log->next();
    if (!event) break;
    count += event->channel.starts_with(channel) ? 1 : 0;
  }
  return count;
}

TEST(Demo, DeliversACoupleBothWaysOnACleanLine) {
  const TestFolder folder("clean");
  const std::string out = folder.path();
  const auto summary = run_demo("--seconds 4", out);
  expect_all_delivered(summary, 2);
  EXPECT_TRUE(fs::exists(summary["log"].get<std::string>()));
}

TEST(Demo, ShowsRemoteDancersByTheRouteOfAnyHouse) {
  const TestFolder folder("route");
  const auto summary = run_demo("--seconds 4 --link delay=40ms", folder.path());
  // What dance join does without a session file.
  const std::vector<dance::Route> routes = dance::default_routes();
  for (const char* house : {"house-a", "house-b"}) {
    const auto session = dance::load_session(folder.path("programs/") + house + ".toml");
    ASSERT_TRUE(session) << session.error().what;
    ASSERT_EQ(session->routes.size(), routes.size());
    for (std::size_t i = 0; i < routes.size(); ++i) {
      EXPECT_EQ(session->routes[i].from.where, routes[i].from.where);
      EXPECT_FALSE(session->routes[i].from.guest.is_set());
      EXPECT_EQ(session->routes[i].through, routes[i].through);
      EXPECT_EQ(session->routes[i].rate_hz, routes[i].rate_hz);
    }
  }
  // 40 ms on the way. docs/latency.md has the command that measures the age of what is shown.
  ASSERT_EQ(summary["guests"].size(), 2u);
  for (const auto& guest : summary["guests"]) {
    EXPECT_GT(guest["staged"].get<std::int64_t>(), 0) << guest;
    for (const auto& step : guest["steps"]) {
      if (step["step"] == "link_received") {
        EXPECT_GT(step["p50_ms"].get<double>(), 35.0) << guest;
      }
    }
  }
}

TEST(Demo, KeepsThirtyDancersWholeAndInStep) {
#ifdef DANCE_SANITIZED
  GTEST_SKIP() << "thirty dancers are too many for two cores under a sanitizer";
#endif
  const TestFolder folder("crowd");
  const auto summary = run_demo("--guests 30 --seconds 4", folder.path());
  expect_all_delivered(summary, 30);
  // In step: a dancer of one house is staged at the same ticks of the other, so that for each
  // pose of theirs that came it is about as many; one whose program came up late has fewer of both.
  std::map<std::string, std::vector<double>> ticks_of_house;
  const auto ticks_a_pose = [](const nlohmann::json& guest) {
    return guest["staged"].get<double>() / std::max(1.0, guest["delivered"].get<double>());
  };
  for (const auto& guest : summary["guests"])
    ticks_of_house[guest["house"].get<std::string>()].push_back(ticks_a_pose(guest));
  for (const auto& guest : summary["guests"]) {
    auto& ticks = ticks_of_house[guest["house"].get<std::string>()];
    std::sort(ticks.begin(), ticks.end());
    EXPECT_GT(guest["staged"].get<std::int64_t>(), 0) << guest;
    EXPECT_GE(ticks_a_pose(guest), 0.5 * ticks[ticks.size() / 2]) << guest;
  }
}

TEST(Demo, AccountsForEveryPoseOfABadLine) {
  const TestFolder folder("line");
  const std::string out = folder.path();
  const std::string trace = folder.path("capacity");
  std::ofstream capacity(trace);
  for (int ms = 0; ms < 1000; ms += 2) capacity << ms << '\n';
  capacity << "1100\n" << std::flush;
  const auto summary = run_demo(
      "--seconds 4 --through hold --link 'delay=40ms jitter=5ms loss=5% seed=3' --trace-up " +
          trace,
      out);
  ASSERT_EQ(summary["guests"].size(), 2u);
  for (const auto& guest : summary["guests"]) {
    std::int64_t lost = 0;
    for (const auto& [cause, count] : guest["lost"].items()) lost += count.get<std::int64_t>();
    EXPECT_EQ(guest["sent"].get<std::int64_t>(), guest["delivered"].get<std::int64_t>() + lost)
        << guest;
    EXPECT_GT(lost, 0) << guest;
    EXPECT_GT(guest["age_p50_ms"].get<double>(), 40.0) << guest;
  }
}

// Not all of one brightness: something is drawn. Width and height stand in the head, 24 bytes in.
void expect_drawn(const std::string& file, std::uint32_t width_px, std::uint32_t height_px) {
  const std::string png = dance::text_of(file);
  ASSERT_GT(png.size(), 24u) << file;
  EXPECT_EQ(png.substr(1, 3), "PNG") << file;
  const auto number = [&](std::size_t at) {
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < 4; ++i) n = n << 8 | static_cast<std::uint8_t>(png[at + i]);
    return n;
  };
  EXPECT_EQ(number(16), width_px) << file;
  EXPECT_EQ(number(20), height_px) << file;
  // A blank sheet of a million pixels takes some thousand bytes.
  EXPECT_GT(png.size(), 20'000u) << file;
}

TEST(Demo, ShowsADancerOnTheBeatBesideThePosesAsTheyCome) {
  const TestFolder folder("compare");
  const std::string out = folder.path();
  const auto summary = run_demo(
      "--seconds 9 --compare --through 'rhythm beats=1' --link 'delay=120ms jitter=15ms loss=1%'",
      out);
  ASSERT_EQ(summary["guests"].size(), 2u) << "twins are no guests";
  expect_all_delivered(summary, 2);
  // Off by more than a third of a beat, and by less than a thirtieth, whatever the machine does
  // meanwhile.
  ASSERT_TRUE(summary.contains("phase_mean_ms")) << summary;
  const auto of = [&](const char* key) { return std::abs(summary[key].get<double>()); };
  EXPECT_GT(of("phase_mean_ms_raw"), 60.0);
  EXPECT_LT(4.0 * of("phase_mean_ms"), of("phase_mean_ms_raw"));
  EXPECT_LT(2.0 * of("phase_sd_ms"), of("phase_sd_ms_raw"));
  EXPECT_GT(of("content_delay_ms_raw"), 100.0);
  EXPECT_GT(of("content_delay_ms"), of("content_delay_ms_raw")) << "a beat later, and true";
  if (!fs::exists(bin("dance-view"))) return;
  expect_drawn(summary["strip"].get<std::string>(), 1440, 800);
  expect_drawn(summary["sway"].get<std::string>(), 1200, 780);
}

TEST(Demo, PlaysTheSongThatItIsGivenInBothHouses) {
  if (!fs::exists(bin("dance-music"))) GTEST_SKIP() << "built without dance music";
  const TestFolder folder("song");
  // A song of silence, at a tempo of its own.
  std::ofstream beats(folder.path("still.beats"));
  for (int i = 0; i < 40; ++i) beats << 0.3 * i << '\t' << i % 4 + 1 << '\n';
  beats.close();
  std::ofstream wav(folder.path("still.wav"), std::ios::binary);
  constexpr std::uint32_t kData_bytes = 2 * 8000 * 12;
  const auto put = [&](std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) wav.put(static_cast<char>(value >> (8 * i) & 0xff));
  };
  wav << "RIFF";
  put(36 + kData_bytes, 4);
  wav << "WAVEfmt ";
  for (const auto& [value, size] :
       {std::pair{16u, 4}, {1u, 2}, {1u, 2}, {8000u, 4}, {16000u, 4}, {2u, 2}, {16u, 2}})
    put(value, size);
  wav << "data";
  put(kData_bytes, 4);
  wav << std::string(kData_bytes, '\0');
  wav.close();
  const auto summary = run_demo(
      "--seconds 8 --compare --through 'rhythm beats=1' --music " + folder.path("still.wav"),
      folder.path());
  ASSERT_TRUE(summary.contains("tempo_bpm")) << summary;
  EXPECT_NEAR(summary["tempo_bpm"].get<double>(), 200.0, 1.0);
  EXPECT_LT(4.0 * std::abs(summary["phase_mean_ms"].get<double>()),
            std::abs(summary["phase_mean_ms_raw"].get<double>()));
}

TEST(Demo, DrawsAFilmOfWhatWasRecorded) {
  if (!fs::exists(bin("dance-view"))) GTEST_SKIP() << "built without the viewer";
  const TestFolder folder("film");
  const auto demo = run_demo("--seconds 7 --compare", folder.path());
  const Finished film = dance::run(
      bin("dance-view") + " --headless --log " + folder.path("demo.lcm") +
      " --compare --film --seconds 0.4 --size " + "320x180 --out " + folder.path("film"));
  EXPECT_EQ(film.exit_code, 0) << film.talk;
  for (int i = 1; i <= 10; ++i) {
    std::array<char, 16> name{};
    std::snprintf(name.data(), name.size(), "/%04d.png", i);
    EXPECT_TRUE(dance::is_private(folder.path("film") + name.data())) << name.data();
  }
  EXPECT_FALSE(fs::exists(folder.path("film") + "/0011.png"));
}

TEST(Demo, NamesATraceThatIsNotThereBeforeAnythingStarts) {
  const TestFolder folder("no-trace");
  const Finished demo = dance::run(bin("dance-demo") + " --headless --out " + folder.path() +
                                   " --trace-down /no/such.trace");
  EXPECT_EQ(demo.exit_code, 1);
  EXPECT_NE(demo.talk.find("/no/such.trace: no such file"), std::string::npos) << demo.talk;
  EXPECT_FALSE(fs::exists(folder.path("demo.lcm")));
}

TEST(Demo, GoesOnWhenAnyOfItsProgramsIsKilledAndItComesBack) {
  const TestFolder folder("kill");
  const std::string out = folder.path(), log = out + "/demo.lcm";
  RunningDemo demo("--seconds 250", out);  // ended when all has been seen
  // Dancers are started when the houses have met, and poses come through when all is up.
  ASSERT_TRUE(wait_for([&] { return count_in_log(log, "POSE/guest/") > 0; })) << "nobody dances";
  struct Victim {
    const char *program, *mark, *gone;
  };
  for (const Victim& victim : {Victim{"/dance-join", "/house-b.toml", "POSE/guest/"},
                               {"/dance-server", "--port", "POSE/guest/"},
                               {"/dance-record", "/demo.lcm", "POSE/"},
                               {"/dance-salsa", " alice ", "POSE/capture/alice"}}) {
    const char *program = victim.program, *mark = victim.mark, *gone = victim.gone;
    pid_t killed = 0, back = 0;
    ASSERT_TRUE(wait_for([&] { return (killed = demo.pid_of(program, mark)) > 0; })) << program;
    ASSERT_TRUE(dance::send_signal(killed, SIGKILL)) << program;
    const auto is_back = [&] { return (back = demo.pid_of(program, mark)) > 0 && back != killed; };
    ASSERT_TRUE(wait_for(is_back)) << program << " is not started again";
    const int before = count_in_log(log, gone);
    ASSERT_TRUE(wait_for([&] { return count_in_log(log, gone) > before + 100; }))
        << gone << " does not go on when " << program << " is back";
  }
  const nlohmann::json& summary = demo.end();
  ASSERT_TRUE(summary.is_object());
  EXPECT_GE(summary["restarts"].get<int>(), 4);
  EXPECT_EQ(summary["guests"].size(), 2u);
  for (const auto& guest : summary["guests"]) EXPECT_GT(guest["delivered"].get<int>(), 0) << guest;
}

TEST(Demo, LeavesAloneWhatIsNotItsOwn) {
  const TestFolder folder("pictures");
  for (const char* name : {"holiday.png", "stage-door.png", "alice.json"})
    std::ofstream(folder.path(name)) << "mine";
  const auto summary = run_demo("--seconds 1", folder.path());
  for (const char* name : {"holiday.png", "stage-door.png", "alice.json"})
    EXPECT_EQ(dance::text_of(folder.path(name)), "mine") << name;
  for (const auto& picture : summary["pictures"])
    EXPECT_EQ(picture.get<std::string>().find("holiday"), std::string::npos);
}

TEST(Demo, RefusesWhatCannotBeInOneLine) {
  for (const auto& [options, word] :
       {std::pair<std::string, std::string>{"--motion /nonexistent.bvh", "nonexistent.bvh"},
        {"--guests 1", "guests"},
        {"--compare --guests 4", "--compare"},
        {"--film", "--film"},
        {"--music /no/song.ogg", "/no/song.ogg"},
        {"--through fly", "fly"},
        {"--nonsense", "nonsense"}}) {
    const TestFolder folder("wrong");
    const Finished demo = dance::run(bin("dance-demo") + " --headless --seconds 1 --out " +
                                     folder.path() + " " + options);
    EXPECT_NE(demo.exit_code, 0) << options;
    EXPECT_NE(demo.talk.find(word), std::string::npos) << options << ": " << demo.talk;
  }
}

}  // namespace
