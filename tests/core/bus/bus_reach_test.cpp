// Tests the senders that a bus receives: this machine's programs with any routes, those of
// other hosts only with ttl=1 or more, and those of LCM's library in both directions.
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/core/bus/bus_help.h"
#include "tests/lan_hosts.h"

namespace dance {
namespace {

constexpr int kPort = 17667;
constexpr const char* kOpenUrl = "udpm://239.255.76.67:17667?ttl=1";

std::string text_message(const std::string& channel) {
  return "LC02" + std::string(4, '\0') + channel + '\0' + "data";
}

// A bus on a host, and how many messages it has received on each channel.
class CountingBus {
 public:
  explicit CountingBus(const LanHost& host, const char* url = kUrl) {
    host.within([&] {
      auto opened = Bus::open(url);
      EXPECT_TRUE(opened) << opened.error().what;
      if (opened) bus_ = std::move(*opened);
    });
    bus_->on_anything([this](std::string_view name, const void*, std::size_t, MonoTime) {
      ++counts_[std::string(name)];
    });
  }
  // True if a message of this channel has arrived, or arrives within two seconds.
  bool has_received(const std::string& channel) {
    drain_until(*bus_, [&] { return counts_[channel] > 0; });
    return counts_[channel] > 0;
  }
  // Handles what is pending, messages and reports of the network.
  void drain_pending() {
    for (pollfd readable{bus_->fd(), POLLIN, 0}; poll(&readable, 1, 0) > 0;)
      bus_->drain(mono_now());
  }
  int count(const std::string& channel) { return counts_[channel]; }
  Bus& bus() { return *bus_; }

 private:
  std::unique_ptr<Bus> bus_;
  std::map<std::string, int> counts_;
};

// A client of liblcm on a host.
class LcmClient {
 public:
  explicit LcmClient(const LanHost& host, const char* url = kUrl) {
    host.within([&] {
      lcm_ = lcm_create(url);
      ASSERT_NE(lcm_, nullptr);
      lcm_subscribe(lcm_, "[A-Z]+/.*", &LcmClient::on_message, this);
    });
  }
  ~LcmClient() { lcm_destroy(lcm_); }
  LcmClient(const LcmClient&) = delete;
  LcmClient& operator=(const LcmClient&) = delete;

  void publish(const std::string& channel) {
    EXPECT_EQ(lcm_publish(lcm_, channel.c_str(), "data", 4), 0);
  }
  bool has_received(const std::string& channel) {
    while (counts_[channel] == 0 && lcm_handle_timeout(lcm_, 2000) > 0) continue;
    return counts_[channel] > 0;
  }

 private:
  static void on_message(const lcm_recv_buf_t*, const char* channel, void* self) {
    ++static_cast<LcmClient*>(self)->counts_[channel];
  }
  lcm_t* lcm_ = nullptr;
  std::map<std::string, int> counts_;
};

// A bus that is open to the network shows that the stranger's datagrams reached this machine.
TEST(BusReach, ReceivesNothingFromAnotherHostWithTtlZero) {
  const Lan lan;
  CountingBus bus(lan.machine), open(lan.machine, kOpenUrl), beside(lan.machine);
  const DatagramSender stranger(lan.stranger);
  for (int i = 0; i < 100; ++i)
    for (const std::uint32_t address : {kMachineAddress, kBusGroup})
      stranger.send(address, kPort, text_message("POSE/capture/alice"));
  stranger.send(kBusGroup, kPort, text_message("POSE/capture/last"));
  ASSERT_TRUE(open.has_received("POSE/capture/last"));
  beside.bus().publish_raw("LIGHT/desk", "on", 2);
  EXPECT_TRUE(bus.has_received("LIGHT/desk"));
  EXPECT_GE(open.count("POSE/capture/alice"), 100);
  EXPECT_EQ(bus.count("POSE/capture/alice"), 0);
  EXPECT_EQ(bus.count("POSE/capture/last"), 0);
}

TEST(BusReach, SendsNothingToAnotherHostWithTtlZero) {
  const Lan lan;
  CountingBus bus(lan.machine), open(lan.machine, kOpenUrl), there(lan.stranger, kOpenUrl);
  bus.bus().publish_raw("LIGHT/desk", "on", 2);
  open.bus().publish_raw("LIGHT/last", "on", 2);
  EXPECT_TRUE(there.has_received("LIGHT/last"));
  EXPECT_EQ(there.count("LIGHT/desk"), 0);
}

TEST(BusReach, IsOpenToTheNetworkWithTtlOne) {
  const Lan lan;
  CountingBus here(lan.machine, kOpenUrl), there(lan.stranger, kOpenUrl);
  here.bus().publish_raw("LIGHT/here", "on", 2);
  there.bus().publish_raw("LIGHT/there", "on", 2);
  EXPECT_TRUE(there.has_received("LIGHT/here"));
  EXPECT_TRUE(here.has_received("LIGHT/there"));
  EXPECT_TRUE(here.has_received("LIGHT/here"));
}

TEST(BusReach, ChecksDatagramsOfOtherHostsWithTtlOneToo) {
  const Lan lan;
  CountingBus bus(lan.machine, kOpenUrl);
  std::vector<std::string> refused;
  bus.bus().on_refused([&](std::string_view name) { refused.emplace_back(name); });
  const DatagramSender stranger(lan.stranger);
  stranger.send(kBusGroup, kPort, "LC02" + std::string(4, '\0') + "no end!!");
  stranger.send(kBusGroup, kPort, text_message("POSE/\x1b[2J"));
  stranger.send(kBusGroup, kPort,
                "LC03" + std::string("\0\0\0\1\0\0\1\0\xff\xff\xff\0\0\0\0\1", 16) +
                    "POSE/stage/alice" + '\0' + std::string(256, 'x'));
  stranger.send(kBusGroup, kPort, text_message("LIGHT/last"));
  EXPECT_TRUE(bus.has_received("LIGHT/last"));
  EXPECT_EQ(bus.bus().counters().malformed, 2u);
  EXPECT_EQ(bus.bus().counters().fragments, 1u);
  EXPECT_EQ(refused, std::vector<std::string>{"POSE/stage/alice"});
}

TEST(BusReach, NeedsARouteOnlyWithTtlOne) {
  const LanHost host;
  host.within([&] {
    const auto down = Bus::open(kUrl);
    ASSERT_FALSE(down);
    EXPECT_NE(down.error().what.find("ip link set lo up"), std::string::npos) << down.error().what;
  });
  ASSERT_EQ(host.run("ip link set lo up").exit_code, 0);
  host.within([&] {
    const auto open = Bus::open(kOpenUrl);
    ASSERT_FALSE(open);
    EXPECT_NE(open.error().what.find("ip route add"), std::string::npos) << open.error().what;
  });
  CountingBus one(host), other(host);
  one.bus().publish_raw("LIGHT/desk", "on", 2);
  EXPECT_TRUE(other.has_received("LIGHT/desk"));
}

// Each change of the routes is between two messages, which must both arrive.
TEST(BusReach, LosesNoMessageWhenRoutesChange) {
  const Lan lan;
  CountingBus sender(lan.machine), receiver(lan.machine);
  int sent = 0;
  const std::vector<std::string> changes = {"ip route del default",
                                            "ip route add prohibit 224.0.0.0/4",
                                            "ip route add prohibit default",
                                            "ip route del prohibit 224.0.0.0/4",
                                            "ip route add 224.0.0.0/4 dev lo",
                                            "ip link set lan0 down",
                                            "ip route del 224.0.0.0/4 dev lo"};
  for (const std::string& change : changes) {
    const std::string channel = "LIGHT/" + std::to_string(sent++);
    ASSERT_EQ(lan.machine.run(change).exit_code, 0) << change;
    sender.bus().publish_raw(channel.c_str(), "on", 2);
    EXPECT_TRUE(receiver.has_received(channel)) << change;
    CountingBus opened_since(lan.machine);
    sender.bus().publish_raw((channel + "/again").c_str(), "on", 2);
    EXPECT_TRUE(opened_since.has_received(channel + "/again")) << change;
  }
  EXPECT_EQ(sender.bus().counters().publish_failed, 0u);
}

// A second network card of the machine, as Wi-Fi beside a cable or a VPN: its other end stays on
// the machine too.
void add_device(const LanHost& host, const std::string& name, const std::string& address) {
  const Finished added = host.run(
      "ip link add " + name + " type veth peer name " + name + "-far && ip addr add " + address +
      "/24 dev " + name + " && ip link set " + name + " up && ip link set " + name + "-far up");
  ASSERT_EQ(added.exit_code, 0) << added.talk;
}

std::string move_route_to(const std::string& device) {
  return "ip route replace 224.0.0.0/4 dev " + device;
}

// Runs a change of the network on the host; returns what the bus prints when it has followed.
std::string change_and_follow(const LanHost& host, CountingBus& bus, const std::string& change) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(host.run(change).exit_code, 0) << change;
  bus.drain_pending();
  return testing::internal::GetCapturedStderr();
}

// Programs of LCM send over the device of the multicast route.
TEST(BusReach, ReceivesLiblcmOverADeviceThatTheRouteHasMovedTo) {
  const Lan lan;
  CountingBus ours(lan.machine);
  ASSERT_NO_FATAL_FAILURE(add_device(lan.machine, "vpn0", "10.77.0.1"));
  const std::string line = change_and_follow(lan.machine, ours, move_route_to("vpn0"));
  EXPECT_NE(line.find("multicast has moved from lan0 to vpn0"), std::string::npos) << line;
  LcmClient theirs(lan.machine);
  theirs.publish("LIGHT/theirs");
  EXPECT_TRUE(ours.has_received("LIGHT/theirs"));
  ours.bus().publish_raw("LIGHT/ours", "data", 4);
  EXPECT_TRUE(theirs.has_received("LIGHT/ours"));
}

// More than the kernel's limit of 20 groups of a socket.
TEST(BusReach, FollowsTheRouteThroughManyDevices) {
  const Lan lan;
  CountingBus ours(lan.machine);
  for (int i = 0; i < 24; ++i) {
    const std::string device = "vpn" + std::to_string(i);
    ASSERT_NO_FATAL_FAILURE(
        add_device(lan.machine, device, "10." + std::to_string(100 + i) + ".0.1"));
    change_and_follow(lan.machine, ours, move_route_to(device));
  }
  LcmClient theirs(lan.machine);
  theirs.publish("LIGHT/theirs");
  EXPECT_TRUE(ours.has_received("LIGHT/theirs"));
}

TEST(BusReach, PrintsOneLineForEachMoveOfTheRouteAndNoneForOtherChanges) {
  const Lan lan;
  CountingBus bus(lan.machine);
  const auto follow = [&](const std::string& change) {
    return change_and_follow(lan.machine, bus, change);
  };
  EXPECT_EQ(follow("ip addr add 10.9.8.7/24 dev lan0"), "");
  EXPECT_EQ(follow("ip route add 192.0.2.0/24 dev lan0"), "");
  const std::string head = std::string("bus ") + kUrl + ": multicast has moved ";
  const std::string tail = "; the dance on this machine goes on over lo\n";
  EXPECT_EQ(follow("ip link set lan0 down"), head + "from lan0 to no device" + tail);
  EXPECT_EQ(follow("ip link set lan0 up && ip route add default via 10.9.8.2"),
            head + "from no device to lan0" + tail);
  EXPECT_EQ(follow("ip route add prohibit 224.0.0.0/4"), head + "from lan0 to no device" + tail);
  EXPECT_EQ(follow("ip route del prohibit 224.0.0.0/4"), head + "from no device to lan0" + tail);
  // VPNs put a rule in front of the main table.
  EXPECT_EQ(follow("ip rule add prohibit priority 100"), head + "from lan0 to no device" + tail);
  EXPECT_EQ(follow("ip addr add 10.9.8.8/24 dev lan0"), "");
}

TEST(BusReach, GoesOnWhenTheLoopbackDeviceIsUpAgain) {
  const Lan lan;
  CountingBus sender(lan.machine), receiver(lan.machine);
  const std::string down = change_and_follow(lan.machine, receiver, "ip link set lo down");
  EXPECT_NE(down.find("ip link set lo up"), std::string::npos) << down;
  const std::string up = change_and_follow(lan.machine, receiver, "ip link set lo up");
  EXPECT_NE(up.find("up again"), std::string::npos) << up;
  sender.bus().publish_raw("LIGHT/desk", "on", 2);
  EXPECT_TRUE(receiver.has_received("LIGHT/desk"));
}

// Each change of the network is between two messages, which must both arrive on this machine.
TEST(BusReach, LosesNoMessageOfThisMachineWhenRoutesChangeWithTtlOne) {
  const Lan lan;
  CountingBus sender(lan.machine, kOpenUrl), receiver(lan.machine, kOpenUrl);
  CountingBus local(lan.machine);
  ASSERT_NO_FATAL_FAILURE(add_device(lan.machine, "vpn0", "10.77.0.1"));
  int sent = 0;
  for (const std::string& change :
       {std::string("ip route del default"), std::string("ip route add prohibit 224.0.0.0/4"),
        std::string("ip route del prohibit 224.0.0.0/4"), move_route_to("vpn0"),
        std::string("ip link set vpn0-far down"), std::string("ip link set vpn0 down"),
        std::string("ip link set lan0 down"), std::string("ip link del vpn0")}) {
    const std::string channel = "LIGHT/" + std::to_string(sent++);
    for (CountingBus* bus : {&sender, &local, &receiver})
      change_and_follow(lan.machine, *bus, bus == &sender ? change : "true");
    sender.bus().publish_raw(channel.c_str(), "on", 2);
    EXPECT_TRUE(receiver.has_received(channel)) << change;
    EXPECT_TRUE(local.has_received(channel)) << change;
    EXPECT_EQ(receiver.count(channel), 1) << change;
  }
  EXPECT_EQ(sender.bus().counters().publish_failed, 0u);
}

TEST(BusReach, FollowsTheNetworkWithTtlOne) {
  const Lan lan;
  CountingBus here(lan.machine, kOpenUrl), there(lan.stranger, kOpenUrl);
  const std::string gone = change_and_follow(lan.machine, here, "ip link set lan0 down");
  EXPECT_NE(gone.find("from lan0 to no device"), std::string::npos) << gone;
  EXPECT_NE(gone.find("other hosts are not reached"), std::string::npos) << gone;
  // Another card, as after a change from Wi-Fi to a cable.
  const std::string back = change_and_follow(
      lan.machine, here,
      "ip link del lan0 && ip link add lan1 type veth peer name lan1 netns " + lan.stranger.pid() +
          " && ip addr add 10.9.7.1/24 dev lan1 && ip link set lan1 up && ip route add default "
          "dev lan1");
  EXPECT_NE(back.find("from no device to lan1; the bus follows"), std::string::npos) << back;
  change_and_follow(lan.stranger, there,
                    "ip addr add 10.9.7.2/24 dev lan1 && ip link set lan1 up && ip route add "
                    "default dev lan1");
  here.bus().publish_raw("LIGHT/here", "on", 2);
  there.bus().publish_raw("LIGHT/there", "on", 2);
  EXPECT_TRUE(there.has_received("LIGHT/here"));
  EXPECT_TRUE(here.has_received("LIGHT/there"));
}

void expect_both_directions(const LanHost& host) {
  CountingBus ours(host);
  LcmClient theirs(host);
  theirs.publish("LIGHT/theirs");
  EXPECT_TRUE(ours.has_received("LIGHT/theirs"));
  ours.bus().publish_raw("LIGHT/ours", "data", 4);
  EXPECT_TRUE(theirs.has_received("LIGHT/ours"));
}

TEST(BusReach, MeetsLiblcmOverTheDefaultDevice) {
  const Lan lan;
  expect_both_directions(lan.machine);
}

TEST(BusReach, MeetsLiblcmOverLoopback) {
  const Lan lan;
  ASSERT_EQ(lan.machine.run("ip route add 224.0.0.0/4 dev lo").exit_code, 0);
  expect_both_directions(lan.machine);
}

TEST(BusReach, RefusesAMessageThatLiblcmSplitsAndNamesIt) {
  const Lan lan;
  CountingBus ours(lan.machine);
  std::vector<std::string> refused;
  ours.bus().on_refused([&](std::string_view name) { refused.emplace_back(name); });
  lcm_t* theirs = nullptr;
  lan.machine.within([&] { theirs = lcm_create(kUrl); });
  ASSERT_NE(theirs, nullptr);
  const std::string large(200'000, 'x'), fits(65'000, 'y');
  lcm_publish(theirs, "CLOUD/points", large.data(), static_cast<unsigned>(large.size()));
  lcm_publish(theirs, "CLOUD/small", fits.data(), static_cast<unsigned>(fits.size()));
  EXPECT_TRUE(ours.has_received("CLOUD/small"));
  lcm_destroy(theirs);
  EXPECT_EQ(ours.count("CLOUD/points"), 0);
  EXPECT_EQ(refused, std::vector<std::string>{"CLOUD/points"});
  EXPECT_EQ(ours.bus().counters().fragments, 4u);
}

TEST(BusReach, KeepsGroupsOnOnePortApart) {
  const Lan lan;
  CountingBus bus(lan.machine), other(lan.machine, "udpm://239.255.76.68:17667?ttl=0");
  CountingBus beside(lan.machine);
  other.bus().publish_raw("LIGHT/other", "on", 2);
  beside.bus().publish_raw("LIGHT/desk", "on", 2);
  EXPECT_TRUE(bus.has_received("LIGHT/desk"));
  EXPECT_TRUE(other.has_received("LIGHT/other"));
  EXPECT_EQ(bus.count("LIGHT/other"), 0);
  EXPECT_EQ(other.count("LIGHT/desk"), 0);
}

TEST(BusReach, CarriesTheLongestMessageAndCountsALongerOneAsFailed) {
  const auto sender = open_bus(), receiver = open_bus();
  std::size_t received = 0;
  receiver->on_anything(
      [&](std::string_view, const void*, std::size_t size, MonoTime) { received = size; });
  const std::string longest(65'507 - 8 - 11, 'x');
  sender->publish_raw("LIGHT/desk", longest.data(), longest.size());
  drain_until(*receiver, [&] { return received > 0; });
  EXPECT_EQ(received, longest.size());
  sender->publish_raw("LIGHT/desk", (longest + "x").data(), longest.size() + 1);
  sender->publish_raw("two\nlines", "x", 1);
  sender->publish_raw("", "x", 1);
  EXPECT_EQ(sender->counters().publish_failed, 3u);
}

}  // namespace
}  // namespace dance
