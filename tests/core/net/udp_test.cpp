// Sockets on this machine's loopback address.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <vector>

#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/system/wake_event.h"
#include "core/net/tcp_socket.h"
#include "core/net/udp_socket.h"
#include "testing/line/lossy_proxy.h"

namespace dance {
namespace {

std::vector<std::uint8_t> bytes(std::size_t size, std::uint8_t fill) {
  return std::vector<std::uint8_t>(size, fill);
}

struct Echo {
  std::vector<std::vector<std::uint8_t>> got;
  Address from;
};

Echo receive_all(UdpSocket& socket, std::size_t count) {
  Echo echo;
  for (int turns = 0; turns < 10'000 && echo.got.size() < count; ++turns)
    for (const auto& datagram : socket.receive()) {
      echo.got.emplace_back(datagram.bytes.begin(), datagram.bytes.end());
      echo.from = datagram.from;
    }
  return echo;
}

TEST(UdpSocket, CarriesBatchesBothWaysOverIpv4) {
  auto server = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(server);
  auto client = UdpSocket::connect(server->local_address());
  ASSERT_TRUE(client);
  for (std::uint8_t i = 0; i < 150; ++i) client->send({}, bytes(100u + i, i));
  client->flush();
  const Echo heard = receive_all(*server, 150);
  ASSERT_EQ(heard.got.size(), 150u);
  EXPECT_EQ(heard.got[149], bytes(249, 149));
  EXPECT_EQ(heard.from, client->local_address());
  server->send_now(heard.from, bytes(3, 7));
  EXPECT_EQ(receive_all(*client, 1).got.at(0), bytes(3, 7));
  EXPECT_EQ(client->counters().sent, 150u);
}

TEST(UdpSocket, WithRoomForThemTakesTheLongestDatagrams) {
  auto roomy = UdpSocket::bind(Address::loopback(0), kLongDatagrams);
  auto usual = UdpSocket::bind(Address::loopback(0));
  auto sender = UdpSocket::bind(Address::loopback(0), kLongDatagrams);
  ASSERT_TRUE(roomy && usual && sender);
  const auto longest = bytes(kLongDatagrams.bytes, 9);
  for (int i = 0; i < 3; ++i) sender->send(roomy->local_address(), longest);
  sender->send(usual->local_address(), longest);
  sender->flush();
  const Echo heard = receive_all(*roomy, 3);
  ASSERT_EQ(heard.got.size(), 3u);
  EXPECT_EQ(heard.got[2], longest);
  EXPECT_TRUE(receive_all(*usual, 1).got.empty());
  EXPECT_EQ(usual->counters().truncated, 1u);
}

TEST(UdpSocket, AGroupOnAnInterfaceThatIsNotHereIsNamedWithTheCure) {
  const auto socket =
      UdpSocket::join(*Address::resolve("239.255.42.99:15110"), *Address::resolve("203.0.113.9:1"));
  ASSERT_FALSE(socket.has_value());
  EXPECT_NE(socket.error().what.find("239.255.42.99"), std::string::npos);
  EXPECT_NE(socket.error().what.find("ip address"), std::string::npos);
  EXPECT_FALSE(UdpSocket::join(*Address::resolve("[ff02::1]:15110"), Address()).has_value());
}

TEST(UdpSocket, AnIpv6SocketHearsIpv4Too) {
  auto server = UdpSocket::bind(Address::resolve("[::]:1")->with_port(0));
  if (!server) GTEST_SKIP() << "no IPv6 here: " << server.error().what;
  const std::uint16_t port = server->local_address().port();
  auto client = UdpSocket::connect(Address::loopback(port));
  ASSERT_TRUE(client);
  client->send_now({}, bytes(5, 1));
  const Echo heard = receive_all(*server, 1);
  ASSERT_EQ(heard.got.size(), 1u);
  EXPECT_EQ(heard.from, client->local_address()) << "as the IPv4 address that it is";
  server->send(heard.from, bytes(6, 2));
  server->flush();
  EXPECT_EQ(receive_all(*client, 1).got.size(), 1u);
}

// A client of 127.0.0.2 receives nothing that comes from 127.0.0.1.
void expect_answers_from_the_asked_address(const Address& wildcard) {
  auto server = UdpSocket::serve(wildcard);
  if (!server) GTEST_SKIP() << server.error().what;
  const std::uint16_t port = server->local_address().port();
  for (const char* ip : {"127.0.0.1:1", "127.0.0.2:1", "127.7.7.7:1"}) {
    auto client = UdpSocket::connect(Address::resolve(ip)->with_port(port));
    ASSERT_TRUE(client);
    client->send_now({}, bytes(5, 1));
    const Echo heard = receive_all(*server, 1);
    ASSERT_EQ(heard.got.size(), 1u);
    EXPECT_EQ(heard.from.to_string(), client->local_address().to_string());
    server->send_now(heard.from, bytes(6, 2));
    server->send(heard.from, bytes(7, 3));
    server->flush();
    const Echo answers = receive_all(*client, 2);
    ASSERT_EQ(answers.got.size(), 2u) << ip;
    EXPECT_EQ(answers.got[0], bytes(6, 2));
    EXPECT_EQ(answers.got[1], bytes(7, 3));
  }
  EXPECT_EQ(server->counters().send_failed, 0u);
}

TEST(UdpSocket, AServerAnswersFromTheAddressThatWasAskedOverIpv4) {
  expect_answers_from_the_asked_address(Address::any_ipv4(0));
}

TEST(UdpSocket, AServerAnswersFromTheAddressThatWasAskedOverBothFamilies) {
  expect_answers_from_the_asked_address(Address::resolve("[::]:1")->with_port(0));
}

// A peer that asks at another of our addresses is another place to answer from.
TEST(UdpSocket, AServersDatagramsDifferByTheAddressThatTheyWereSentTo) {
  auto server = UdpSocket::serve(Address::any_ipv4(0));
  ASSERT_TRUE(server);
  auto client = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(client);
  const std::uint16_t port = server->local_address().port();
  const auto from_of = [&](const char* ip) {
    client->send_now(Address::resolve(ip)->with_port(port), bytes(5, 1));
    return receive_all(*server, 1).from;
  };
  const Address first = from_of("127.0.0.1:1"), second = from_of("127.0.0.2:1");
  EXPECT_FALSE(first == second);
  EXPECT_EQ(first, from_of("127.0.0.1:1"));
  EXPECT_EQ(first.ip(), second.ip());
  EXPECT_EQ(second.asked_ip()[3], 2);
  EXPECT_FALSE(client->local_address().has_asked_ip());
}

TEST(UdpSocket, NamesAPortThatIsTaken) {
  auto first = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(first);
  const Address taken = first->local_address();
  const auto second = UdpSocket::bind(taken);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("port " + std::to_string(taken.port()) + " is taken"),
            std::string::npos);
  EXPECT_NE(second.error().what.find("choose another port"), std::string::npos);
}

TEST(UdpSocket, NamesABroadcastAddress) {
  // The loopback network has one of its own.
  const auto socket = UdpSocket::connect(*Address::resolve("127.255.255.255:9"));
  ASSERT_FALSE(socket);
  EXPECT_EQ(
      socket.error().what,
      "127.255.255.255:9 is a broadcast address, which stands for all hosts of a network: name "
      "the address of one host");
}

TEST(UdpSocket, NamesTheLimitOfOpenFiles) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{3, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const auto socket = UdpSocket::bind(Address::loopback(0));
  const auto event = WakeEvent::create();
  const auto poller = Poller::create();
  const auto port = try_tcp_port(Address::loopback(0));
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  ASSERT_FALSE(socket || event || poller || port);
  for (const std::string& what :
       {socket.error().what, event.error().what, poller.error().what, port.error().what})
    EXPECT_NE(what.find("too many open files in this program; raise the limit with: ulimit -n"),
              std::string::npos)
        << what;
}

TEST(TcpPort, NamesWhyItCannotBeUsed) {
  auto first = UdpSocket::bind(Address::loopback(0));
  EXPECT_TRUE(try_tcp_port(first->local_address())) << "UDP's ports are others";
  EXPECT_NE(try_tcp_port(*Address::resolve("192.0.2.77:9464")).error().what.find("192.0.2.77"),
            std::string::npos);
}

TEST(WakeEvent, IsReadableFromSignalToClear) {
  auto event = WakeEvent::create();
  ASSERT_TRUE(event);
  const WakeEvent moved = std::move(*event);
  const auto poller = Poller::create();
  int woken = 0;
  (*poller)->watch(moved.fd(), [&](MonoTime) {
    ++woken;
    moved.clear();
  });
  moved.signal();
  moved.signal();
  (*poller)->run_once(Duration::s(10));
  (*poller)->run_once(Duration());
  EXPECT_EQ(woken, 1);
}

TEST(UdpSocket, NamesAnAddressThatIsNotOurs) {
  const auto socket = UdpSocket::bind(*Address::resolve("192.0.2.77:7400"));
  ASSERT_FALSE(socket);
  EXPECT_NE(socket.error().what.find("192.0.2.77"), std::string::npos);
}

TEST(UdpSocket, DropsAndCountsWhatIsLongerThanAnythingOfOurs) {
  auto server = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(server);
  auto client = UdpSocket::connect(server->local_address());
  ASSERT_TRUE(client);
  client->send_now({}, bytes(5000, 1));
  client->send_now({}, bytes(10, 2));
  EXPECT_EQ(receive_all(*server, 1).got.at(0), bytes(10, 2));
  EXPECT_EQ(server->counters().truncated, 1u);
}

TEST(UdpSocket, AnEarlierRefusalDoesNotSwallowTheNextDatagram) {
  auto server = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(server);
  const Address address = server->local_address();
  auto client = UdpSocket::connect(address);
  ASSERT_TRUE(client);
  *server = *UdpSocket::bind(Address::loopback(0));  // nobody is at the first address now
  client->send_now({}, bytes(1, 1));
  auto again = UdpSocket::bind(address);
  ASSERT_TRUE(again);
  client->send_now({}, bytes(2, 2));
  EXPECT_EQ(receive_all(*again, 1).got.at(0), bytes(2, 2));
  EXPECT_EQ(client->counters().refused, 1u);
}

TEST(LossyProxy, CarriesBothWaysAndCountsWhatItLoses) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  auto target = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(target);
  auto proxy =
      LossyProxy::open(Address::loopback(0), target->local_address(),
                       *load_line({.link = "loss=30% seed=2 dup=10% delay=1ms"}), **poller);
  ASSERT_TRUE(proxy);
  auto client = UdpSocket::connect((*proxy)->local_address());
  ASSERT_TRUE(client);
  std::uint64_t up = 0;
  std::uint64_t down = 0;
  for (int i = 0; i < 400; ++i) {
    client->send_now({}, bytes(50, 1));
    (*poller)->run_once(Duration::ms(1));
    for (const auto& datagram : target->receive()) {
      ++up;
      target->send_now(datagram.from, datagram.bytes);
    }
    down += client->receive().size();
  }
  using Direction = LossyProxy::Direction;
  const auto done = [&] {
    const auto u = (*proxy)->totals(Direction::kUp);
    const auto d = (*proxy)->totals(Direction::kDown);
    return u.line.offered == 400 && u.delivered == u.line.forwarded + u.line.duplicated &&
           up == u.delivered && d.line.offered == up &&
           d.delivered == d.line.forwarded + d.line.duplicated && down == d.delivered;
  };
  for (int i = 0; i < 1000 && !done(); ++i) {
    (*poller)->run_once(Duration::ms(1));
    for (const auto& datagram : target->receive()) {
      ++up;
      target->send_now(datagram.from, datagram.bytes);
    }
    down += client->receive().size();
  }
  EXPECT_TRUE(done());
  EXPECT_EQ((*proxy)->client_count(), 1u);
  EXPECT_NEAR(static_cast<double>((*proxy)->totals(Direction::kUp).line.lost), 120.0, 40.0);
}

// Traces belong to the line, not to a client.
TEST(LossyProxy, BeginsItsTracesWithTheFirstClientAndNotAnewWithOthers) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  auto target = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(target);
  auto proxy = LossyProxy::open(Address::loopback(0), target->local_address(), {}, **poller);
  ASSERT_TRUE(proxy);
  EXPECT_FALSE((*proxy)->begin().is_set());
  MonoTime begin;
  for (std::size_t clients = 1; clients <= 3; ++clients) {
    auto client = UdpSocket::connect((*proxy)->local_address());
    ASSERT_TRUE(client);
    client->send_now({}, bytes(50, 1));
    for (int i = 0; i < 10'000 && (*proxy)->client_count() < clients; ++i)
      (*poller)->run_once(Duration::ms(1));
    ASSERT_EQ((*proxy)->client_count(), clients);
    if (clients == 1) begin = (*proxy)->begin();
    EXPECT_TRUE(begin.is_set());
    EXPECT_EQ((*proxy)->begin(), begin);
  }
}

}  // namespace
}  // namespace dance
