// The cluster of examples/cluster/ on loopback: three NATS servers with the files that are shipped,
// in which only addresses and the folder of values are others, and certificates of the test's own.
//
// Units/frames: none.
// Ownership:    the fixture's programs and files end with the test.
// Threads:      one.
// Failure:      what does not come up in time fails the test.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/program/child_process.h"
#include "tests/apps/run_program.h"
#include "tests/tunnel/seal/paper.h"

namespace dance {

inline void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

class ClusterOperation : public ::testing::Test {
 protected:
  static constexpr int kNats = 3;

  void SetUp() override {
    const Authority authority = make_papers();
    ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    ::setenv("XDG_CONFIG_HOME", folder_.path("server-config").c_str(), 1);
    for (int i = 1; i <= kNats; ++i) start_nats(i);
    ASSERT_TRUE(wait_for([&] {
      return run(server("dance-server") + " --list-keys").exit_code == 0;
    })) << run(server("dance-server") + " --list-keys").talk
        << text_of(folder_.path("nats-1.log"));
  }
  void TearDown() override {
    for (auto& [name, child] : programs_) child->stop(Duration::s(5));
    EXPECT_EQ(text_of(folder_.path("talk")).find("Sanitizer"), std::string::npos);
    ::unsetenv("XDG_RUNTIME_DIR");
  }

  Authority make_papers() {
    Authority authority(folder_.path(), "ca");
    authority.sign("nats", "IP:127.0.0.1,IP:127.0.0.2,IP:127.0.0.3");
    for (const char* user : {"dance-server", "dance-operator", "stranger"})
      authority.sign(user, "");
    for (const std::string name : {"accounts", "nats-1", "nats-2", "nats-3"}) {
      std::string text =
          text_of(std::string(DANCE_SOURCE_DIR) + "/examples/cluster/" + name + ".conf");
      EXPECT_FALSE(text.empty()) << name;
      if (name != "accounts") replace_all(text, "0.0.0.0", "127.0.0." + name.substr(5));
      for (int i = 1; i <= kNats; ++i)
        replace_all(text, "nats-" + std::to_string(i) + ".example.org",
                    "127.0.0." + std::to_string(i));
      replace_all(text, "/var/lib/nats", folder_.path(name + ".js"));
      std::ofstream(folder_.path(name + ".conf")) << text;
    }
    return authority;
  }

  void start_nats(int number) {
    const std::string name = "nats-" + std::to_string(number);
    start(name, "/bin/sh",
          {"-c", "cd " + folder_.path() + " && exec " + NATS_SERVER + " -c " + name + ".conf >>" +
                     name + ".log 2>&1"});
  }
  ChildProcess& start(const std::string& name, const std::string& program,
                      std::vector<std::string> arguments) {
    auto child = ChildProcess::start(
        {program, std::move(arguments), folder_.path("output"), folder_.path(name + ".talk")});
    EXPECT_TRUE(child) << child.error().what;
    programs_.erase(name);
    return *programs_.emplace(name, std::make_unique<ChildProcess>(std::move(*child)))
                .first->second;
  }
  void kill_program(const std::string& name) { programs_.at(name)->kill_now(); }
  std::string talk_of(const std::string& name) const {
    return text_of(folder_.path(name + ".talk"));
  }

  static std::string urls() {
    return "tls://127.0.0.1:4222,tls://127.0.0.2:4222,tls://127.0.0.3:4222";
  }
  std::vector<std::string> as(const std::string& user) const {
    return {"--cluster",
            urls(),
            "--cluster-authorities",
            folder_.path("ca.pem"),
            "--cluster-certificate",
            folder_.path(user + ".pem"),
            "--cluster-private-key",
            folder_.path(user + ".key")};
  }
  std::string command(const std::string& program, const std::string& user) const {
    std::string line = bin(program);
    for (const std::string& word : as(user)) line += " " + word;
    return line;
  }
  std::string server(const std::string& user) const { return command("dance-server", user); }

  void start_server(int number) {
    std::vector<std::string> arguments = as("dance-server");
    const std::string port = std::to_string(7400 + number);
    arguments.insert(arguments.end(), {"--port", port, "--cluster-address", "127.0.0.1:" + port});
    start("server-" + std::to_string(number), bin("dance-server"), arguments);
  }
  // Null until the server shows one.
  static nlohmann::json status_of(int number) {
    return nlohmann::json::parse(run(bin("dance-status") + " --cluster --once --json --port " +
                                     std::to_string(7400 + number))
                                     .output,
                                 nullptr, false);
  }
  template <class Condition>
  static bool comes_true(int number, const Condition& holds) {
    return wait_for([&] {
      const nlohmann::json status = status_of(number);
      return status.is_object() && holds(status);
    });
  }
  static std::size_t alive_in(const nlohmann::json& status) {
    std::size_t alive = 0;
    for (const auto& other : status["cluster"]["servers"]) alive += other["alive"] == true ? 1 : 0;
    return alive;
  }
  static std::size_t links_of(const nlohmann::json& status) {
    std::size_t links = 0;
    for (const auto& room : status["rooms"]) links += room["links"].size();
    return links;
  }

  TestFolder folder_{"cluster-operation"};
  std::map<std::string, std::unique_ptr<ChildProcess>> programs_;
};

}  // namespace dance
