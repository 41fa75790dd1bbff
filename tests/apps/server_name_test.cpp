// dance link to a server by its name, whose address changes or cannot be resolved: with a hosts
// file and a resolver of the test's own.
#include <gtest/gtest.h>

#include <deque>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core/net/udp_socket.h"
#include "core/program/child_process.h"
#include "tests/apps/run_program.h"

namespace dance {
namespace {

constexpr const char* kServer = "dance.example.test";

class ServerName : public testing::Test {
 protected:
  void SetUp() override {
    if (run("unshare -m true").exit_code != 0)
      GTEST_SKIP() << "no mount namespace can be made here";
    set_hosts("");
    // A name server that receives requests and answers none.
    silent_ = *UdpSocket::bind(Address::resolve("127.0.0.53:53").value());
    std::ofstream(folder_.path("resolv.conf"))
        << "nameserver 127.0.0.53\noptions timeout:30 attempts:5\n";
    ASSERT_EQ(run(config("server") + bin("dance-server") + " --new-guest alice --address " +
                  kServer + " >" + folder_.path("line"))
                  .exit_code,
              0);
    ASSERT_EQ(run(config("house") + bin("dance-key") + " <" + folder_.path("line")).exit_code, 0);
    start("server", "exec env " + config("server") + bin("dance-server") + " --bind 127.0.0.2");
  }
  std::string config(const std::string& who) const {
    return "XDG_CONFIG_HOME=" + folder_.path(who) + " ";
  }
  // Writes the file in place: it is mounted, so it cannot be replaced.
  void set_hosts(const std::string& address) const {
    std::ofstream(folder_.path("hosts")) << "127.0.0.1 localhost\n"
                                         << (address.empty() ? "" : address + " " + kServer + "\n");
  }
  ChildProcess& start(const std::string& name, const std::string& command) {
    auto child = ChildProcess::start(
        {"/bin/sh", {"-c", command}, folder_.path(name + ".out"), folder_.path(name + ".txt")});
    EXPECT_TRUE(child) << child.error().what;
    return children_.emplace_back(std::move(*child));
  }
  // `files`: the name service of /etc/nsswitch.conf, "files" or "files dns".
  ChildProcess& start_link(const std::string& services) {
    std::ofstream(folder_.path("nsswitch.conf")) << "hosts: " << services << "\n";
    std::string command;
    for (const char* file : {"hosts", "resolv.conf", "nsswitch.conf"})
      command += "mount --bind " + folder_.path(file) + " /etc/" + file + " && ";
    return start("link", "exec unshare -m sh -c \"" + command + "exec env " + config("house") +
                             bin("dance-link") + " --server " + kServer + " --guest alice\"");
  }
  bool link_tells(const std::string& words) const {
    return wait_for([&] { return talk().find(words) != std::string::npos; });
  }
  std::string talk() const { return text_of(folder_.path("link.txt")); }

  TestFolder folder_{"server-name"};
  std::optional<UdpSocket> silent_;
  std::deque<ChildProcess> children_;  // references to them hold
};

TEST_F(ServerName, ALinkConnectsOnceAnUnknownNameIsResolved) {
  start_link("files");
  ASSERT_TRUE(link_tells("'dance.example.test' is unknown")) << talk();
  set_hosts("127.0.0.2");
  EXPECT_TRUE(link_tells("in room 'dance'")) << talk();
}

TEST_F(ServerName, ALinkFollowsANameToItsNewAddress) {
  set_hosts("127.0.0.9");  // nothing listens there
  start_link("files");
  ASSERT_TRUE(link_tells("asks dance.example.test")) << talk();
  set_hosts("127.0.0.2");
  EXPECT_TRUE(link_tells("is at 127.0.0.2:7400 now")) << talk();
  EXPECT_TRUE(link_tells("in room 'dance'")) << talk();
}

// The resolver would ask for two and a half minutes.
TEST_F(ServerName, ALinkStartsAndEndsWhileTheNameServerIsSilent) {
  ChildProcess& link = start_link("files dns");
  ASSERT_TRUE(link_tells("the name server does not answer")) << talk();
  ASSERT_TRUE(link_tells("Ctrl-C ends it")) << talk();
  link.ask_to_stop();
  EXPECT_TRUE(wait_for([&] { return link.has_ended(); })) << talk();
  EXPECT_TRUE(link.ended_well()) << link.exit_text();
}

}  // namespace
}  // namespace dance
