// dance receive with senders whose datagrams give no pose: the lines that it prints.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "core/net/udp_socket.h"
#include "core/program/child_process.h"
#include "tests/apps/run_program.h"

namespace dance {
namespace {

class ReceiveProgram : public testing::Test {
 protected:
  void start(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"--guest", "carol", "--bus", "udpm://239.255.76.67:7741?ttl=0"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    auto child = ChildProcess::start(
        {bin("dance-receive"), all, folder_.path("output"), folder_.path("talk")});
    ASSERT_TRUE(child) << child.error().what;
    child_.emplace(std::move(*child));
  }
  // Sends a datagram again and again until the program has printed a line.
  bool tells(const std::string& words, const Address& to = Address(),
             const std::vector<std::uint8_t>& datagram = {}) {
    std::optional<UdpSocket> sender;
    if (to.is_set()) sender.emplace(*UdpSocket::connect(to));
    return wait_for([&] {
      if (sender) sender->send_now({}, datagram);
      return talk().find(words) != std::string::npos;
    });
  }
  std::string talk() const { return text_of(folder_.path("talk")); }

  TestFolder folder_{"receive-program"};
  std::optional<ChildProcess> child_;
};

// A bone of VMC protocol with numbers of a type, 8 bytes each of doubles.
std::vector<std::uint8_t> vmc_bone_of_doubles() {
  std::vector<std::uint8_t> bytes;
  const auto text = [&](const std::string& words) {
    bytes.insert(bytes.end(), words.begin(), words.end());
    do bytes.push_back(0);
    while (bytes.size() % 4 != 0);
  };
  text("/VMC/Ext/Bone/Pos");
  text(",sddddddd");
  text("Hips");
  bytes.resize(bytes.size() + 6 * 8);  // zeros
  constexpr std::array<std::uint8_t, 8> kOne{0x3f, 0xf0};
  bytes.insert(bytes.end(), kOne.begin(), kOne.end());  // w = 1.0
  return bytes;
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

TEST_F(ReceiveProgram, ReportsVmcThatIsSentToTheOtherLoopbackAddress) {
  start({"--from", "vmc"});
  EXPECT_TRUE(tells("vmc: nothing arrives at 127.0.0.1:39539")) << talk();
  EXPECT_TRUE(tells("--listen [::1]:39539", *Address::resolve("[::1]:39539"),
                    std::vector<std::uint8_t>(300, 'x')))
      << talk();
}

TEST_F(ReceiveProgram, ReportsVmcWithDoubles) {
  start({"--from", "vmc"});
  EXPECT_TRUE(tells("let the program send floats", Address::loopback(39539), vmc_bone_of_doubles()))
      << talk();
}

TEST_F(ReceiveProgram, ReportsAnOlderVersionOfRokoko) {
  start({"--from", "rokoko"});
  EXPECT_TRUE(tells("choose JSON v3", Address::loopback(14043),
                    bytes_of(R"({"version":"2,0","timestamp":1.0,"actors":[]})")))
      << talk();
}

TEST_F(ReceiveProgram, ReportsThatUnicastNatNetNeedsAServer) {
  start({"--from", "natnet", "--listen", "127.0.0.1:1511"});
  EXPECT_TRUE(tells("natnet: nothing arrives at 127.0.0.1:1511")) << talk();
  EXPECT_NE(talk().find("?server="), std::string::npos) << talk();
}

}  // namespace
}  // namespace dance
