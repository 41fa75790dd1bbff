// Two hosts of a LAN, each a network namespace of its own: the machine of a house, and a stranger.
// A pair of virtual network cards connects them, and each has its default route over that card. For
// flow tests, which run in a private network already.
//
// Ownership: the namespaces end with the object; sockets opened in them may live longer.
// Failure:   a host that cannot be made fails the test that asked for it.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "core/program/child_process.h"
#include "tests/apps/run_program.h"

namespace dance {

class LanHost {
 public:
  LanHost() {
    auto child = ChildProcess::start({"unshare", {"-n", "sleep", "600"}});
    if (!child) {
      ADD_FAILURE() << child.error().what;
      return;
    }
    children_.push_back(std::move(*child));
    const auto network_of = [](const std::string& process) {
      std::error_code error;
      return std::filesystem::read_symlink("/proc/" + process + "/ns/net", error);
    };
    EXPECT_TRUE(wait_for([&] { return network_of(pid()) != network_of("self"); }));
  }

  std::string pid() const { return std::to_string(children_.front().pid()); }
  // A command line of a shell, run to its end on this host.
  Finished run(const std::string& command) const {
    return dance::run("nsenter -n -t " + pid() + " -- sh -c '" + command + "'");
  }
  // A program that runs on this host until it is stopped.
  ChildProcess start(const std::string& program, const std::vector<std::string>& arguments,
                     const std::string& output_file = "", const std::string& talk_file = "") const {
    std::vector<std::string> all{"-n", "-t", pid(), "--", program};
    all.insert(all.end(), arguments.begin(), arguments.end());
    auto child = ChildProcess::start({"nsenter", all, output_file, talk_file});
    if (!child) ADD_FAILURE() << child.error().what;
    return std::move(*child);
  }
  // Calls `work` in a thread of this host; sockets that it opens stay on this host.
  template <class Work>
  void within(const Work& work) const {
    std::thread([&] {
      const int network = open(("/proc/" + pid() + "/ns/net").c_str(), O_RDONLY | O_CLOEXEC);
      EXPECT_EQ(setns(network, CLONE_NEWNET), 0);
      close(network);
      work();
    }).join();
  }

 private:
  std::vector<ChildProcess> children_;
};

struct Lan {
  static constexpr const char* kMachine = "10.9.8.1";
  static constexpr const char* kStranger = "10.9.8.2";

  Lan() {
    const std::string link = "ip link add lan0 type veth peer name lan0 netns " + stranger.pid();
    EXPECT_EQ(machine.run(link).exit_code, 0);
    for (const auto& [host, own, other] :
         {std::tuple(&machine, kMachine, kStranger), {&stranger, kStranger, kMachine}}) {
      const Finished set_up =
          host->run("ip link set lo up && ip addr add " + std::string(own) +
                    "/24 dev lan0 && ip link set lan0 up && ip route add default via " + other);
      EXPECT_EQ(set_up.exit_code, 0) << set_up.talk;
    }
  }
  LanHost machine, stranger;
};

// Sends datagrams from a host: to a group with TTL 1, over the device of its route.
class DatagramSender {
 public:
  explicit DatagramSender(const LanHost& host) {
    host.within([this] { fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0); });
    EXPECT_GE(fd_, 0);
  }
  ~DatagramSender() { close(fd_); }
  DatagramSender(const DatagramSender&) = delete;
  DatagramSender& operator=(const DatagramSender&) = delete;

  // `address` is 32 bits, its first byte the highest.
  void send(std::uint32_t address, int port, std::string_view bytes) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(address);
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    EXPECT_EQ(sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                     sizeof to),
              static_cast<ssize_t>(bytes.size()));
  }

 private:
  int fd_ = -1;
};

constexpr std::uint32_t kBusGroup = 0xefff4c43;        // 239.255.76.67
constexpr std::uint32_t kMachineAddress = 0x0a090801;  // Lan::kMachine
constexpr std::uint32_t kLoopbackAddress = 0x7f000001;

}  // namespace dance
