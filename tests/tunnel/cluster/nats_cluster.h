// A real cluster on this machine: NATS servers, dance servers as programs of their own, and links
// in the test's process.
//
// Ownership: programs and files end with it.
// Threads:   one.
// Failure:   what does not come up fails the test, with what the programs said.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "tests/apps/run_program.h"
#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/link/link.h"

namespace dance {

class NatsCluster : public ::testing::Test {
 protected:
  static constexpr int kClientPort = 24'220, kRoutePort = 24'320, kServerPort = 24'400;

  struct Guest {
    GuestId id;
    wire::RoomName room;
    std::unique_ptr<Link> link;
    std::uint32_t next_sequence = 1;
    std::map<GuestId, std::uint64_t> heard;
    std::map<GuestId, FileHash> files;                      // of avatars that are chosen
    std::map<GuestId, std::vector<std::uint8_t>> has_come;  // whole files
    std::uint64_t joined = 0, left = 0;                     // others, as it was told
    std::map<GuestId, std::uint64_t> voices;                // packets
  };

  void SetUp() override {
    for (const char* path : {"/usr/sbin/nats-server", "/usr/bin/nats-server"})
      if (std::filesystem::exists(path)) nats_program_ = path;
    if (nats_program_.empty())
      GTEST_SKIP() << "nats-server is not installed: apt-get install nats-server";
    ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller = std::move(*made);
  }
  void TearDown() override {
    guests.clear();
    for (auto& server : servers_) server.reset();
    for (auto& nats : nats_) nats.reset();
    ::unsetenv("XDG_RUNTIME_DIR");
    EXPECT_EQ(talk().find("Sanitizer"), std::string::npos) << talk();
  }

  void start_nats(std::size_t which, std::size_t of, const std::vector<std::string>& also = {}) {
    const auto number = [](int port, std::size_t i) {
      return std::to_string(port + static_cast<int>(i));
    };
    std::vector<std::string> arguments{"-a",
                                       "127.0.0.1",
                                       "-p",
                                       number(kClientPort, which),
                                       "-js",
                                       "-sd",
                                       folder_.path("nats-" + std::to_string(which)),
                                       "-l",
                                       folder_.path("nats-log-" + std::to_string(which))};
    arguments.insert(arguments.end(), also.begin(), also.end());
    if (of > 1) {
      std::string routes;
      for (std::size_t i = 0; i < of; ++i)
        if (i != which)
          routes += (routes.empty() ? "" : ",") + std::string("nats://127.0.0.1:") +
                    number(kRoutePort, i);
      const std::vector<std::string> more{
          "--server_name",  "n" + std::to_string(which),
          "--cluster_name", "dance",
          "--cluster",      "nats://127.0.0.1:" + number(kRoutePort, which),
          "--routes",       routes};
      arguments.insert(arguments.end(), more.begin(), more.end());
    }
    nats_.resize(std::max(nats_.size(), which + 1));
    nats_[which] = start(nats_program_, arguments);
    ASSERT_TRUE(wait_for([&] { return is_heard(kClientPort + static_cast<int>(which)); }));
  }
  std::string urls() const {
    std::string list;
    for (std::size_t i = 0; i < nats_.size(); ++i) list += (i == 0 ? "" : ",") + url_of(i);
    return list;
  }
  static std::string url_of(std::size_t nats) {
    return "nats://127.0.0.1:" + std::to_string(kClientPort + static_cast<int>(nats));
  }

  static Address address_of(std::size_t server) {
    return Address::loopback(static_cast<std::uint16_t>(kServerPort + static_cast<int>(server)));
  }
  void start_server(std::size_t which) { start_server(which, urls()); }
  void start_server(std::size_t which, const std::string& nats,
                    const std::vector<std::string>& also = {}) {
    const std::string port = std::to_string(address_of(which).port());
    servers_.resize(std::max(servers_.size(), which + 1));
    std::vector<std::string> arguments{
        "--port", port, "--cluster", nats, "--cluster-address", "127.0.0.1:" + port};
    arguments.insert(arguments.end(), also.begin(), also.end());
    servers_[which] = start(bin("dance-server"), arguments);
  }
  // Straight away, as by the kernel.
  static void kill_now(std::unique_ptr<ChildProcess>& program) {
    program->kill_now();
    program.reset();
  }

  Guest& add_guest(const std::string& name, std::size_t server, const std::string& room = "salsa") {
    Guest& added = *guests.emplace_back(std::make_unique<Guest>());
    added.id = guest(name);
    added.room = guest(room);
    LinkHandlers handlers;
    handlers.on_pose = [&added](const GuestId& id, const Pose&, MonoTime) { ++added.heard[id]; };
    handlers.on_voice = [&added](const GuestId& id, const Voice&, MonoTime) { ++added.voices[id]; };
    handlers.on_guest_joined = [&added](const GuestId&, MonoTime) { ++added.joined; };
    handlers.on_guest_left = [&added](const GuestId&, MonoTime) { ++added.left; };
    handlers.on_avatar_file = [&added](const GuestId& id, const AvatarFile& file, MonoTime) {
      added.files[id] = file.hash;
    };
    handlers.on_file = [&added](const GuestId& id, const FileHash& hash, ChunkedFile&& file) {
      auto& bytes = added.has_come[id];
      for (std::size_t i = 0; i < file.chunks(); ++i)
        bytes.insert(bytes.end(), file.chunk(i).begin(), file.chunk(i).end());
      added.link->core().files().settle(id, hash, FileVerdict::kRight);
    };
    LinkOptions options;
    options.room = added.room;
    EXPECT_TRUE(options.guests.try_push(added.id));
    const auto key =
        choose_link_key(address_of(server).to_string(), options.room, added.id, LinkKeySource());
    EXPECT_TRUE(key) << key.error().what;
    auto link = Link::open({address_of(server)}, *key, options, std::move(handlers), *poller);
    EXPECT_TRUE(link) << link.error().what;
    added.link = std::move(*link);
    return added;
  }

  // All send a pose each 1/30 s while it turns.
  bool dance_until(const std::function<bool()>& is_so, Duration longest = Duration::s(40)) {
    const MonoTime given_up = mono_now() + longest;
    bool so = is_so();
    for (; !so && mono_now() < given_up; so = is_so()) {
      const MonoTime now = mono_now();
      if (now >= next_frame_) {
        next_frame_ = now + Duration::us(33'333);
        for (auto& one : guests)
          one->link->send(one->id, pose_number(one->next_sequence++, now, this_clock_id()), now);
      }
      poller->run_once(Duration::ms(2));
    }
    return so;
  }
  void dance(Duration duration) {
    const MonoTime end = mono_now() + duration;
    dance_until([&] { return mono_now() >= end; }, duration + Duration::s(1));
  }
  // Each has heard this many more poses of each other in its room.
  bool all_hear_all(std::uint64_t poses, Duration longest = Duration::s(40)) {
    for (auto& one : guests) one->heard.clear();
    return dance_until(
        [&] {
          for (const auto& one : guests)
            for (const auto& other : guests) {
              if (one == other || one->room != other->room) continue;
              const auto heard = one->heard.find(other->id);
              if (heard == one->heard.end() || heard->second < poses) return false;
            }
          return true;
        },
        longest);
  }

  std::string talk() const { return text_of(folder_.path("talk")); }
  // And what each server knows of the others, and the NATS servers' own words.
  std::string all_talk() const {
    std::string all = talk();
    for (std::size_t i = 0; i < servers_.size(); ++i)
      if (servers_[i])
        all += run(bin("dance-status") + " --cluster --once --port " +
                   std::to_string(address_of(i).port()))
                   .output;
    for (std::size_t i = 0; i < nats_.size(); ++i)
      all += text_of(folder_.path("nats-log-" + std::to_string(i)));
    return all;
  }

  TestFolder folder_{"nats-cluster"};
  std::unique_ptr<Poller> poller;
  std::vector<std::unique_ptr<Guest>> guests;
  std::vector<std::unique_ptr<ChildProcess>> nats_, servers_;

 private:
  std::unique_ptr<ChildProcess> start(const std::string& program,
                                      std::vector<std::string> arguments) {
    auto child = ChildProcess::start(
        {program, std::move(arguments), folder_.path("output"), folder_.path("talk")});
    if (!child) {
      ADD_FAILURE() << child.error().what;
      return nullptr;
    }
    return std::make_unique<ChildProcess>(std::move(*child));
  }

  static bool is_heard(int port) {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const bool is_there = ::connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
    ::close(fd);
    return is_there;
  }

  std::string nats_program_;
  MonoTime next_frame_;
};

}  // namespace dance
