// A server as it is run for others: its status, its metrics, its end, and the unit that starts it.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/program/child_process.h"
#include "tests/apps/bus_programs.h"
#include "tests/apps/http_get.h"
#include "tunnel/link/link.h"
#include "tunnel/seal/keys/key_files.h"

namespace dance {
namespace {

constexpr const char* kServerPort = "7471";
constexpr std::uint16_t kMetricsPort = 9471;

class ServerPrograms : public BusPrograms {
 protected:
  // Sockets of this test's own, as the folder of a user's session.
  void SetUp() override { ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1); }
  void TearDown() override {
    end_all();
    EXPECT_EQ(talk().find("Sanitizer"), std::string::npos) << talk();
    ::unsetenv("XDG_RUNTIME_DIR");
  }

  static std::string status_command(const std::string& options) {
    return bin("dance-status") + " --port " + kServerPort + " " + options;
  }
  // The status once it is as wanted; null if that never comes.
  template <class Condition>
  static nlohmann::json status_when(const Condition& is_as_wanted) {
    nlohmann::json status;
    wait_for([&] {
      status = nlohmann::json::parse(run(status_command("--once --json")).output, nullptr, false);
      return status.is_object() && is_as_wanted(status);
    });
    return status;
  }
  static std::size_t guests_in(const nlohmann::json& status) {
    std::size_t guests = 0;
    for (const auto& room : status["rooms"])
      for (const auto& link : room["links"]) guests += link["guests"].size();
    return guests;
  }
  std::string talk() const { return text_of(folder_.path("talk")); }

  // The exposer hears before it knows its page: at first there may be none.
  static bool is_page(const std::string& answer) {
    return answer.starts_with("HTTP/1.1 200 OK\r\n");
  }
  // A build without Prometheus says so.
  static bool has_metrics() {
    const Finished refused = run(bin("dance-server") + " --port 7473 --metrics no-such.invalid");
    return refused.talk.find("without Prometheus") == std::string::npos;
  }

  ChildProcess& start_server(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--port", kServerPort});
    return start("dance-server", more);
  }
  void start_dancer(const std::string& guest, const char* bus) {
    start("dance-link", {"--server", std::string("127.0.0.1:") + kServerPort, "--room", "salsa",
                         "--guest", guest, "--bus", bus});
    start("dance-salsa", {"--guest", guest, "--bus", bus});
  }
};

TEST_F(ServerPrograms, StatusTellsWhoIsThereAndHowTheyFare) {
  start_server();
  start_dancer("alice", kBus);
  start_dancer("bob", kOtherBus);
  const auto status = status_when([&](const nlohmann::json& now) {
    if (guests_in(now) != 2) return false;
    for (const auto& link : now["rooms"][0]["links"])
      if (link["guests"][0]["poses"] < 50 || link["round_trip_ms"].is_null() ||
          link["jitter_ms"].is_null() || link["loss_down"].is_null())
        return false;
    return true;
  });
  ASSERT_TRUE(status.is_object()) << talk();
  ASSERT_EQ(guests_in(status), 2u) << status << talk();
  EXPECT_EQ(status["rooms"][0]["name"], "salsa");
  EXPECT_EQ(status["rooms"][0]["codec"], "lattice");
  EXPECT_EQ(status["handshakes"]["done"], 2);
  EXPECT_EQ(status["handshakes"]["wrong_key"], 0);
  for (const auto& link : status["rooms"][0]["links"]) {
    EXPECT_GT(link["round_trip_ms"].get<double>(), 0.0) << link;
    EXPECT_GT(link["bytes_in_per_s"].get<double>(), 0.0) << link;
    EXPECT_GT(link["bytes_out_per_s"].get<double>(), 0.0) << link;
    EXPECT_LE(link["loss_up"].get<double>(), 1.0) << link;
  }
  const Finished table = run(status_command("--once"));
  EXPECT_EQ(table.exit_code, 0) << table.talk;
  EXPECT_TRUE(has_all(table.output, {"salsa", "alice", "bob", "lattice", "127.0.0.1:7471"}))
      << table.output;
}

TEST_F(ServerPrograms, TheLogListsJoinsAndRefusalsAlsoAfterARestart) {
  ::setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
  ChildProcess& server = start_server();
  start_dancer("alice", kBus);
  const std::string line = "dance-key:mallory@127.0.0.1#" +
                           server_identity(folder_.path("dance/server-keys"))->public_key().text();
  ASSERT_EQ(run("mkdir -p -m 700 " + folder_.path("stranger/dance") + " && echo '" + line +
                "' | XDG_CONFIG_HOME=" + folder_.path("stranger") + " " + bin("dance-key"))
                .exit_code,
            0);
  start("/bin/sh", {"-c", "XDG_CONFIG_HOME=" + folder_.path("stranger") + " exec " +
                              bin("dance-link") + " --server 127.0.0.1:" + kServerPort +
                              " --room salsa --guest mallory --bus '" + kOtherBus + "'"});
  const Finished log = run_until(status_command("--log"), [](const Finished& now) {
    return has_all(now.output, {"joined", "alice", "salsa", "refused", "mallory", "unknown_name"});
  });
  EXPECT_TRUE(has_all(log.output, {"joined", "alice", "refused", "mallory", "127.0.0.1:"}))
      << log.output << log.talk << talk();
  server.ask_to_stop();
  ASSERT_TRUE(wait_for([&] { return server.has_ended(); }));
  EXPECT_TRUE(server.ended_well()) << server.exit_text();
  end_all();
  start_server();
  const Finished again = run_until(status_command("--log --json"), [](const Finished& now) {
    return now.exit_code == 0 && !now.output.empty();
  });
  EXPECT_TRUE(has_all(again.output, {R"("what":"joined")", R"("guests":"alice")",
                                     R"("key":"mallory")", R"("cause":"unknown_name")"}))
      << again.output << again.talk;
  ::setenv("XDG_CONFIG_HOME", DANCE_BINARY_DIR "/test-config", 1);
}

TEST_F(ServerPrograms, AGuestWithAnExpiredKeyGetsTheReasonAndJoinsWithANewKey) {
  const PrivateKey grant = PrivateKey::make();
  const std::string key = grant.public_key().text();
  const std::string keys = folder_.path("server-keys");
  const std::string line = "dance-key:alice@127.0.0.1#" +
                           server_identity(keys)->public_key().text() + "." + grant.text();
  const auto write_keys = [&](const std::string& until) {
    const std::string next = keys + ".new";
    std::ofstream(next) << "alice guest * " << key << " until " << until << "\n";
    std::filesystem::permissions(next, std::filesystem::perms::owner_read);
    std::filesystem::rename(next, keys);
  };
  const std::string home = "XDG_CONFIG_HOME=" + folder_.path("house");
  ASSERT_EQ(run("mkdir -p -m 700 " + folder_.path("house/dance") + " && echo '" + line + "' | " +
                home + " " + bin("dance-key"))
                .exit_code,
            0);
  write_keys("20200101T0000Z");
  start_server({"--keys", keys});
  start("/bin/sh", {"-c", home + " exec " + bin("dance-link") + " --server 127.0.0.1:" +
                              kServerPort + " --room salsa --guest alice --bus " + quoted(kBus)});
  const auto count_lines = [&] {
    std::size_t count = 0;
    const std::string text = talk();
    for (std::size_t at = 0; (at = text.find("key has expired", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  EXPECT_TRUE(wait_for([&] { return count_lines() > 0; })) << talk();
  EXPECT_EQ(run(status_command("--once")).output.find("alice"), std::string::npos);
  write_keys("20990101T0000Z");
  const Finished status = run_until(status_command("--once"), [](const Finished& now) {
    return now.output.find("alice") != std::string::npos;
  });
  EXPECT_NE(status.output.find("key until 2099-01-01 00:00 UTC"), std::string::npos)
      << status.output << talk();
  const std::size_t lines_before = count_lines();
  write_keys("20200101T0000Z");
  EXPECT_TRUE(wait_for([&] { return count_lines() > lines_before; })) << talk();
  const Finished log = run(status_command("--log"));
  EXPECT_TRUE(has_all(log.output, {"joined", "removed", "key_expired"})) << log.output;
}

TEST_F(ServerPrograms, StatusOfNoServerSaysHowToStartOne) {
  for (const char* options : {"--once", "--once --json", ""}) {
    const Finished none = run(status_command(options));
    EXPECT_EQ(none.exit_code, 1) << none.talk;
    EXPECT_EQ(none.output, "");
    EXPECT_EQ(std::count(none.talk.begin(), none.talk.end(), '\n'), 1) << none.talk;
    EXPECT_NE(none.talk.find("dance server --port 7471"), std::string::npos) << none.talk;
  }
  EXPECT_EQ(run(bin("dance-status") + " --port 0").exit_code, 2);
}

TEST_F(ServerPrograms, StatusOfAnothersServerSaysWhose) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can be two users";
  // By way of a folder that user 65534 may enter, as the tree's own may be closed.
  const std::string copies = "/tmp/dance-status-" + std::to_string(getpid());
  ASSERT_EQ(
      run("mkdir -m 755 " + copies + " && cp " + bin("dance-status") + " " + copies).exit_code, 0);
  start_server();
  ASSERT_TRUE(status_when([](const auto&) { return true; }).is_object()) << talk();
  const Finished refused =
      run("env -u XDG_RUNTIME_DIR setpriv --reuid 65534 --regid 65534 --clear-groups " + copies +
          "/dance-status --once --port " + kServerPort);
  EXPECT_EQ(run("rm -r " + copies).exit_code, 0);
  EXPECT_EQ(refused.exit_code, 1) << refused.talk;
  EXPECT_NE(refused.talk.find("not yours but that of user 0"), std::string::npos) << refused.talk;
}

TEST_F(ServerPrograms, AKilledServersSocketIsReplaced) {
  ChildProcess& first = start_server();
  ASSERT_TRUE(status_when([](const auto&) { return true; }).is_object()) << talk();
  first.kill_now();
  EXPECT_TRUE(std::filesystem::exists(folder_.path("dance/server-7471.sock")));
  EXPECT_EQ(run(status_command("--once")).exit_code, 1);
  start_server();
  EXPECT_TRUE(status_when([](const auto&) { return true; }).is_object()) << talk();
  end_all();
  EXPECT_FALSE(std::filesystem::exists(folder_.path("dance/server-7471.sock")));
}

TEST_F(ServerPrograms, MetricsAreAPageThatPrometheusReads) {
  if (!has_metrics()) GTEST_SKIP() << "built without Prometheus";
  start_server({"--metrics", "127.0.0.1:" + std::to_string(kMetricsPort)});
  ASSERT_TRUE(wait_for([&] { return is_page(http_get(kMetricsPort, "/metrics")); })) << talk();
  std::string page;
  start_dancer("alice", kBus);
  start_dancer("bob", kOtherBus);
  const std::string alice = "dance_server_guest_poses_total{room=\"salsa\",guest=\"alice\"} ";
  const std::string jitter = "dance_server_guest_jitter_seconds{room=\"salsa\",guest=\"bob\"} ";
  const auto poses = [&] {
    const std::size_t at = page.find(alice);
    return at == std::string::npos ? 0.0 : std::strtod(page.c_str() + at + alice.size(), nullptr);
  };
  EXPECT_TRUE(wait_for([&] {
    // Some who ask do not wait for the answer: that may end nothing.
    http_ask_and_leave(kMetricsPort, "/metrics");
    page = http_get(kMetricsPort, "/metrics");
    return poses() > 50.0 && page.find(jitter) != std::string::npos;
  })) << page
      << talk();
  EXPECT_TRUE(has_all(page, {"Content-Type: text/plain", "\ndance_server_guests 2\n",
                             "\ndance_server_rooms 1\n", "dance_server_rejected_total{cause=\""}))
      << page;
  // Each line is a comment, or a name with labels and a number.
  std::istringstream lines(page.substr(page.find("\r\n\r\n") + 4));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    char* end = nullptr;
    const std::string number = line.substr(line.rfind(' ') + 1);
    std::strtod(number.c_str(), &end);
    EXPECT_EQ(*end, '\0') << line;
  }
  // A house that ends leaves the page.
  for (ChildProcess& child : children_)
    if (&child != &children_[0]) child.stop(Duration::s(5));
  EXPECT_TRUE(wait_for([&] {
    page = http_get(kMetricsPort, "/metrics");
    return page.find("\ndance_server_guests 0\n") != std::string::npos;
  })) << page;
  EXPECT_EQ(page.find("alice"), std::string::npos);
  ChildProcess& server = children_[0];
  server.ask_to_stop();
  EXPECT_TRUE(wait_for([&] { return server.has_ended(); }));
  EXPECT_TRUE(server.ended_well()) << server.exit_text() << talk();
}

TEST_F(ServerPrograms, MetricsThatCannotBeHadAreOneLine) {
  if (!has_metrics()) GTEST_SKIP() << "built without Prometheus";
  start_server({"--metrics", "127.0.0.1:" + std::to_string(kMetricsPort)});
  ASSERT_TRUE(wait_for([&] { return is_page(http_get(kMetricsPort, "/metrics")); })) << talk();
  struct Case {
    const char* address;
    const char* cause;
  };
  // The web server of Debian's library has no IPv6; another may.
  for (const Case& each : {Case{"127.0.0.1:9471", "port 9471 is taken"},
                           Case{"192.0.2.77:9472", "is not one of this machine's"},
                           Case{"[::1]:9473", "has no IPv6; use 127.0.0.1:9473"},
                           Case{"no-such.invalid", "no-such.invalid"}}) {
    const Finished refused = run(bin("dance-server") + " --port 7472 --metrics " + each.address);
    EXPECT_EQ(refused.exit_code, 1) << refused.talk;
    EXPECT_EQ(std::count(refused.talk.begin(), refused.talk.end(), '\n'), 1) << refused.talk;
    EXPECT_NE(refused.talk.find(each.address), std::string::npos) << refused.talk;
    EXPECT_NE(refused.talk.find(each.cause), std::string::npos) << refused.talk;
  }
}

TEST_F(ServerPrograms, MetricsForEverybodyComeWithAWarning) {
  if (!has_metrics()) GTEST_SKIP() << "built without Prometheus";
  start_server({"--metrics", "0.0.0.0:" + std::to_string(kMetricsPort)});
  EXPECT_TRUE(wait_for([&] { return is_page(http_get(kMetricsPort, "/metrics")); })) << talk();
  EXPECT_NE(talk().find("all who reach 0.0.0.0:9471 see who dances"), std::string::npos) << talk();
  end_all();
  std::filesystem::remove(folder_.path("talk"));
  start_server({"--metrics", "127.0.0.1:" + std::to_string(kMetricsPort)});
  EXPECT_TRUE(wait_for([&] { return is_page(http_get(kMetricsPort, "/metrics")); })) << talk();
  EXPECT_EQ(talk().find("all who reach"), std::string::npos) << talk();
}

TEST_F(ServerPrograms, AnEndingServerTellsItsLinksAtOnce) {
  // A link that hears nothing notices after 900 ms. To tell that from a goodbye, it must have
  // noticed earlier: where this machine was too slow for that, once more.
  constexpr Duration kSilence = Duration::ms(900);
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  bool is_told = false;
  ASSERT_TRUE(wait_for([&] {
    ChildProcess& server = start_server();
    LinkOptions options;
    options.room = *GuestId::parse("salsa");
    if (!options.guests.try_push(*GuestId::parse("alice"))) return false;
    const auto key = choose_link_key("127.0.0.1:7471", options.room, options.guests[0], {});
    if (!key) return false;
    auto link = Link::open({Address::loopback(7471)}, *key, options, {}, **poller);
    if (!link) return false;
    const auto turn_until = [&](bool is_connected) {
      const MonoTime give_up = mono_now() + Duration::s(30);
      MonoTime last = mono_now();
      while ((*link)->is_connected() != is_connected && mono_now() < give_up) {
        last = mono_now();
        (*poller)->run_once(Duration::ms(1));
      }
      return last;
    };
    turn_until(true);
    if (!(*link)->is_connected()) return false;
    const MonoTime connected = mono_now();
    server.ask_to_stop();
    turn_until(false);
    is_told = !(*link)->is_connected() && mono_now() - connected < kSilence;
    if (!wait_for([&] { return server.has_ended(); })) return false;
    EXPECT_TRUE(server.ended_well()) << server.exit_text();
    return is_told;
  })) << talk();
  EXPECT_TRUE(is_told);
}

// The unit's command line and the words that it says for systemd.
class Unit : public ServerPrograms {
 protected:
  static std::string setting(const std::string& name) {
    std::istringstream lines(text_of(kUnit));
    std::string found;
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with(name + "=")) found = line.substr(name.size() + 1);
    return found;
  }
  static constexpr const char* kUnit = DANCE_SOURCE_DIR "/data/systemd/dance-server.service";
};

TEST_F(Unit, StartsAServerThatTellsSystemdHowItFares) {
  const std::string command = setting("ExecStart");
  const std::string program = "dance server ";
  ASSERT_TRUE(command.starts_with(program)) << command;
  ASSERT_EQ(setting("Type"), "notify");
  sockaddr_un at{};
  at.sun_family = AF_UNIX;
  const std::string name = folder_.path("notify");
  std::strcpy(at.sun_path, name.c_str());  // NOLINT: fits
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  std::string heard;
  const auto hears = [&](const char* word) {
    return wait_for([&] {
      std::array<char, 256> text;
      for (ssize_t n; (n = ::recv(fd, text.data(), text.size(), 0)) > 0;)
        heard += std::string(text.data(), static_cast<std::size_t>(n)) + "\n";
      return heard.find(word) != std::string::npos;
    });
  };
  // A build without Prometheus refuses --metrics, which is another test.
  std::string arguments = command.substr(program.size());
  EXPECT_TRUE(arguments.starts_with("--bind :: ")) << "IPv4 and IPv6: " << arguments;
  if (!has_metrics()) arguments = arguments.substr(0, arguments.find(" --metrics"));
  ChildProcess& server =
      start("/bin/sh", {"-c", "NOTIFY_SOCKET=" + name + " WATCHDOG_USEC=100000 exec " +
                                  bin("dance") + " server " + arguments});
  EXPECT_TRUE(hears("READY=1\n")) << talk();
  EXPECT_TRUE(hears("WATCHDOG=1\n")) << talk();
  EXPECT_EQ(heard.find("STOPPING"), std::string::npos);
  server.ask_to_stop();
  EXPECT_TRUE(hears("STOPPING=1\n")) << talk();
  EXPECT_TRUE(wait_for([&] { return server.has_ended(); }));
  EXPECT_TRUE(server.ended_well()) << server.exit_text();
  ::close(fd);
}

TEST_F(Unit, IsOneThatSystemdTakes) {
  if (run("systemd-analyze --version").exit_code != 0) GTEST_SKIP() << "systemd is not here";
  // The program is not installed here: another one stands in its place.
  const std::string unit = folder_.path("dance-server.service");
  ASSERT_EQ(run("sed 's|^ExecStart=dance|ExecStart=/bin/true|' " + std::string(kUnit) + " >" + unit)
                .exit_code,
            0);
  const Finished verified = run("systemd-analyze verify --man=no " + unit + " 2>&1");
  EXPECT_EQ(verified.exit_code, 0) << verified.output;
  EXPECT_EQ(verified.output.find("dance-server.service:"), std::string::npos) << verified.output;
}

}  // namespace
}  // namespace dance
