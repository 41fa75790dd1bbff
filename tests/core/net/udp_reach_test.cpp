// Tests that a server on a machine with several addresses answers from the one that was asked, and
// what the routes of a machine forbid.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/net/machine_addresses.h"
#include "core/net/udp_socket.h"
#include "tests/lan_hosts.h"

namespace dance {
namespace {

const std::vector<std::uint8_t> kQuestion{1, 2, 3}, kAnswer{4, 5};

// Waits some seconds for datagrams; one needs far less.
std::vector<UdpSocket::Datagram> await_datagrams(UdpSocket& socket) {
  std::vector<UdpSocket::Datagram> got;
  wait_for(
      [&] {
        const auto batch = socket.receive();
        got.assign(batch.begin(), batch.end());
        return !got.empty();
      },
      std::chrono::seconds(5));
  return got;
}

TEST(UdpReach, AnswersFromEachAddressOfAMachineWithSeveral) {
  const Lan lan;
  for (const auto& [host, last] : {std::pair(&lan.machine, 1), {&lan.stranger, 2}}) {
    const std::string number = std::to_string(last);
    ASSERT_EQ(host->run("ip -6 addr add fd00:9:8::" + number + "/64 dev lan0 nodad").exit_code, 0);
  }
  ASSERT_EQ(lan.machine
                .run("ip addr add 10.9.8.11/24 dev lan0 && ip addr add 10.44.0.1/32 dev lo && "
                     "ip -6 addr add fd00:9:8::11/64 dev lan0 nodad && "
                     "ip -6 addr add fd00:44::1/128 dev lo nodad")
                .exit_code,
            0);
  ASSERT_EQ(lan.stranger.run("ip -6 route add fd00:44::/64 via fd00:9:8::1").exit_code, 0);
  std::unique_ptr<UdpSocket> server;
  lan.machine.within([&] {
    auto opened = UdpSocket::serve(Address::resolve("[::]:1")->with_port(7400));
    ASSERT_TRUE(opened) << opened.error().what;
    server = std::make_unique<UdpSocket>(std::move(*opened));
  });
  ASSERT_NE(server, nullptr);
  for (const char* asked : {"10.9.8.1:7400", "10.9.8.11:7400", "10.44.0.1:7400",
                            "[fd00:9:8::1]:7400", "[fd00:9:8::11]:7400", "[fd00:44::1]:7400"}) {
    std::unique_ptr<UdpSocket> client;
    lan.stranger.within([&] {
      auto opened = UdpSocket::connect(*Address::resolve(asked));
      ASSERT_TRUE(opened) << opened.error().what;
      client = std::make_unique<UdpSocket>(std::move(*opened));
    });
    ASSERT_NE(client, nullptr);
    client->send_now({}, kQuestion);
    const auto questions = await_datagrams(*server);
    ASSERT_EQ(questions.size(), 1u) << asked;
    server->send(questions[0].from, kAnswer);
    server->flush();
    EXPECT_EQ(await_datagrams(*client).size(), 1u) << asked;
  }
  EXPECT_EQ(server->counters().send_failed, 0u);
}

// Between the two hosts lies a router whose next link carries 576 bytes, and which reports nothing.
TEST(UdpReach, TheLargestDatagramsCrossANarrowLinkThatReportsNothing) {
  const Lan lan;
  const LanHost far;
  ASSERT_EQ(
      lan.machine
          .run("ip link add far0 mtu 576 type veth peer name far0 mtu 576 netns " + far.pid() +
               " && ip addr add 10.9.9.1/24 dev far0 && ip link set far0 up && "
               "echo 1 >/proc/sys/net/ipv4/ip_forward && "
               "ip rule add iif lo to 10.9.8.2 blackhole")
          .exit_code,
      0);
  ASSERT_EQ(far.run("ip addr add 10.9.9.2/24 dev far0 && ip link set far0 up && "
                    "ip route add default via 10.9.9.1")
                .exit_code,
            0);
  std::unique_ptr<UdpSocket> server, client;
  far.within([&] {
    auto opened = UdpSocket::serve(Address::resolve("[::]:1")->with_port(7400));
    ASSERT_TRUE(opened) << opened.error().what;
    server = std::make_unique<UdpSocket>(std::move(*opened));
  });
  lan.stranger.within([&] {
    auto opened = UdpSocket::connect(*Address::resolve("10.9.9.2:7400"));
    ASSERT_TRUE(opened) << opened.error().what;
    client = std::make_unique<UdpSocket>(std::move(*opened));
  });
  ASSERT_TRUE(server && client);
  const std::vector<std::uint8_t> large(1200, 7);
  client->send_now({}, large);
  const auto questions = await_datagrams(*server);
  ASSERT_EQ(questions.size(), 1u);
  EXPECT_EQ(questions[0].bytes.size(), large.size());
  server->send(questions[0].from, large);
  server->flush();
  const auto answers = await_datagrams(*client);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].bytes.size(), large.size());
}

// An address that this machine has lost is no source: the datagram is counted, the others leave.
TEST(UdpReach, CountsAnAnswerFromAnAddressThatIsGone) {
  auto server = UdpSocket::serve(Address::any_ipv4(0));
  auto client = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(server && client);
  const Address there = client->local_address();
  const Address gone = there.with_asked(*Address::resolve("192.0.2.7:1"));
  server->send(gone, kAnswer);
  server->send(there, kQuestion);
  server->flush();
  EXPECT_EQ(server->counters().send_failed, 1u);
  EXPECT_EQ(server->counters().sent, 1u);
  EXPECT_EQ(await_datagrams(*client).size(), 1u);
}

TEST(MachineRoutes, DistinguishAForbiddenRouteFromAMissingOne) {
  const Lan lan;
  const Address elsewhere = *Address::resolve("198.51.100.1:9");
  const auto expect_route = [&](const char* change, const char* device, bool is_forbidden) {
    ASSERT_EQ(lan.machine.run(change).exit_code, 0) << change;
    lan.machine.within([&] {
      EXPECT_EQ(device_towards(elsewhere), device) << change;
      EXPECT_EQ(is_route_forbidden(elsewhere), is_forbidden) << change;
    });
  };
  expect_route("ip route show", "lan0", false);
  expect_route("ip route del default", "", false);
  expect_route("ip route add prohibit default", "", true);
}

}  // namespace
}  // namespace dance
