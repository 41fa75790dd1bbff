// Turns of newcomers: fairness among networks, bounds, and the reserve for known ones.
#include "tunnel/seal/newcomer_queue.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/allocation_guard.h"
#include "tunnel/seal/recent_networks.h"
#include "tunnel/seal/source_limits.h"

namespace dance {
namespace {

Address address(const std::string& text) { return *Address::resolve(text + ":7"); }
Address in_48(unsigned site, unsigned subnet) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "[2001:db8:%x:%x::1]", site, subnet);
  return address(text.data());
}

constexpr std::array<std::uint8_t, 3> kHello{1, 2, 3};
const MonoTime kStart = MonoTime::from_us(1'000'000);

TEST(NetworkLevels, NamesEachWiderNetwork) {
  const auto here = NetworkLevels::of(address("[2001:db8:1:203::9]"));
  EXPECT_EQ(here.prefix, (std::array<std::uint64_t, 4>{0x20010db8'00000000, 0x20010db8'00010000,
                                                       0x20010db8'00010200, 0x20010db8'00010203}));
  const auto ipv4 = NetworkLevels::of(address("192.0.2.7"));
  EXPECT_EQ(ipv4.prefix, (std::array<std::uint64_t, 4>{0xffff'c000'0000, 0xffff'c000'0200,
                                                       0xffff'c000'0207, 0xffff'c000'0207}));
}

TEST(NewcomerQueue, GivesTurnsToNetworksNotToAddresses) {
  NewcomerQueue queue(64, 1);
  std::uint64_t id = 4;
  for (unsigned i = 0; i < 40; ++i) queue.push(in_48(1, i), id += 4, kHello, false, kStart);
  for (int i = 0; i < 4; ++i)
    queue.push(address("198.51.100." + std::to_string(i + 1)), id += 4, kHello, false, kStart);
  std::map<Address::Family, int> served;
  for (int i = 0; i < 8; ++i) ++served[queue.pop()->from.family()];
  EXPECT_EQ(served[Address::Family::kIpv4], 4);
  EXPECT_EQ(served[Address::Family::kIpv6], 4);
}

TEST(NewcomerQueue, SharesTurnsOfAWideNetworkAmongItsParts) {
  NewcomerQueue queue(64, 1);
  std::uint64_t id = 4;
  // One /48 sends from 30 /64s, another /48 of the same /32 sends from one.
  for (unsigned i = 0; i < 30; ++i) queue.push(in_48(1, i), id += 4, kHello, false, kStart);
  queue.push(in_48(2, 0), id += 4, kHello, false, kStart);
  queue.pop();
  EXPECT_EQ(queue.pop()->from, in_48(2, 0));
  // Within the first /48: a /56 that has had no turn comes before one that has.
  queue.push(in_48(1, 0x5500), id += 4, kHello, false, kStart);
  EXPECT_EQ(queue.pop()->from, in_48(1, 0x5500));
}

TEST(NewcomerQueue, DropsFromTheFullestNetworkWhenFull) {
  NewcomerQueue queue(8, 1);
  const Address guest = address("198.51.100.7");
  queue.push(guest, 4, kHello, false, kStart);
  for (unsigned i = 0; i < 100; ++i) {
    const auto pushed = queue.push(in_48(1, i), 8 + 4 * i, kHello, false, kStart);
    EXPECT_EQ(pushed, i < 7 ? NewcomerQueue::Pushed::kWaits : NewcomerQueue::Pushed::kOtherDropped);
  }
  EXPECT_EQ(queue.size(), 8u);
  std::size_t of_guest = 0;
  while (const auto* newcomer = queue.pop()) of_guest += newcomer->from == guest ? 1 : 0;
  EXPECT_EQ(of_guest, 1u);
}

TEST(NewcomerQueue, HoldsOneDatagramOfASession) {
  NewcomerQueue queue(8, 1);
  EXPECT_EQ(queue.push(in_48(1, 1), 4, kHello, false, kStart), NewcomerQueue::Pushed::kWaits);
  EXPECT_EQ(queue.push(in_48(1, 1), 4, kHello, false, kStart),
            NewcomerQueue::Pushed::kWaitsAlready);
  const std::vector<std::uint8_t> longer(seal::kMaxSealed + 1);
  EXPECT_EQ(queue.push(in_48(1, 1), 8, longer, false, kStart), NewcomerQueue::Pushed::kTooLong);
  EXPECT_EQ(queue.size(), 1u);
}

TEST(NewcomerQueue, ForgetsWhatWaitedTooLong) {
  NewcomerQueue queue(8, 1);
  queue.push(in_48(1, 1), 4, kHello, false, kStart);
  queue.push(in_48(1, 2), 8, kHello, true, kStart + Duration::s(1));
  EXPECT_EQ(queue.drop_late(kStart + NewcomerQueue::kLongestWait), 0u);
  EXPECT_EQ(queue.drop_late(kStart + NewcomerQueue::kLongestWait + Duration::ms(1)), 1u);
  EXPECT_TRUE(queue.has_known());
  EXPECT_EQ(queue.pop_known()->id, 8u);
  EXPECT_EQ(queue.pop_known(), nullptr);
  EXPECT_EQ(queue.pop(), nullptr);
}

TEST(NewcomerQueue, ServesKnownNetworksFromTheirReserve) {
  NewcomerQueue queue(8, 1);
  queue.push(in_48(1, 1), 4, kHello, false, kStart);
  queue.push(in_48(1, 2), 8, kHello, true, kStart);
  EXPECT_EQ(queue.pop_known()->id, 8u);
  EXPECT_FALSE(queue.has_known());
  EXPECT_EQ(queue.pop()->id, 4u);
}

TEST(NewcomerQueue, AllocatesNothingAfterConstruction) {
  NewcomerQueue queue(256, 1);
  AllocationGuard guard;
  for (unsigned i = 0; i < 1000; ++i) queue.push(in_48(i % 7, i), 4 + 4 * i, kHello, false, kStart);
  while (queue.pop() != nullptr) {
  }
}

TEST(RecentNetworks, OneKeyCannotPushOutTheNetworksOfAnother) {
  RecentNetworks recent(3);
  recent.note("alice", address("198.51.100.7"), kStart);
  for (unsigned i = 0; i < 5000; ++i) recent.note("mallory", in_48(1, i), kStart + Duration::us(i));
  EXPECT_TRUE(recent.contains(address("198.51.100.7"), kStart + Duration::s(60)));
  EXPECT_TRUE(recent.contains(in_48(1, 4999), kStart + Duration::s(60)));
  EXPECT_FALSE(recent.contains(in_48(1, 4995), kStart + Duration::s(60)));
  EXPECT_FALSE(recent.contains(address("198.51.100.8"), kStart));
  EXPECT_FALSE(
      recent.contains(address("198.51.100.7"), kStart + RecentNetworks::kLately + Duration::s(1)));
}

TEST(SourceLimits, AWideNetworkCannotUseUpTheCommonRate) {
  SourceLimits limits({100.0, 200.0, 1000.0, 400.0}, 5);
  MonoTime now = kStart;
  // 3,000 a second from as many /64s of one /48, for ten seconds.
  std::size_t passed = 0;
  for (unsigned i = 0; i < 30'000; ++i) {
    now += Duration::us(333);
    passed += limits.take(in_48(1, i), now) == SourceLimits::Answer::kYes ? 1 : 0;
    if (i % 300 == 299) {
      EXPECT_EQ(limits.take(address("198.51.100.7"), now), SourceLimits::Answer::kYes);
    }
  }
  EXPECT_GT(passed, 1000u);
  EXPECT_LT(passed, 11'000u);
}

}  // namespace
}  // namespace dance
