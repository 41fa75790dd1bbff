#include "core/net/address.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(Address, ReadsWhatItWrites) {
  for (const char* text : {"127.0.0.1:7400", "[::1]:7400", "[2001:db8::5]:1", "0.0.0.0:65535"}) {
    const auto address = Address::resolve(text);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->to_string(), text);
  }
}

TEST(Address, TakesTheDefaultPortWhereNoneIsGiven) {
  EXPECT_EQ(Address::resolve("127.0.0.1", 7400)->port(), 7400);
  EXPECT_EQ(Address::resolve("::1", 7400)->to_string(), "[::1]:7400");
  EXPECT_EQ(Address::resolve("[::1]", 7400)->port(), 7400);
  EXPECT_EQ(Address::resolve("127.0.0.1:9", 7400)->port(), 9);
}

TEST(Address, NamesABadPortAndTheCure) {
  for (const char* text :
       {"127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1:7x", "127.0.0.1"}) {
    const auto address = Address::resolve(text);
    ASSERT_FALSE(address) << text;
    EXPECT_NE(address.error().what.find(text), std::string::npos);
    EXPECT_NE(address.error().what.find("port of 1 to 65535"), std::string::npos);
  }
}

TEST(Address, NamesWhatIsNoAddress) {
  for (const char* text : {"", ":7400", "[::1", "[::1]x:3"})
    EXPECT_FALSE(Address::resolve(text, 7400)) << text;
  const auto unknown = Address::resolve("no-such-host.invalid:7400");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().what.find("'no-such-host.invalid' is unknown"), std::string::npos);
}

TEST(Address, AMappedIpv4AddressIsThatIpv4Address) {
  const Address v4 = Address::loopback(5000);
  sockaddr_storage raw{};
  ASSERT_GT(v4.to_sockaddr(Address::Family::kIpv6, raw), 0u);
  EXPECT_EQ(raw.ss_family, AF_INET6);
  EXPECT_EQ(Address::from_sockaddr(raw), v4);
  EXPECT_TRUE(v4.is_loopback());
  EXPECT_EQ(Address::resolve("[::1]:1")->to_sockaddr(Address::Family::kIpv4, raw), 0u);
}

TEST(Address, KnowsTheGroupsOfMulticast) {
  EXPECT_TRUE(Address::resolve("224.0.0.1:1")->is_multicast());
  EXPECT_TRUE(Address::resolve("239.255.42.99:1")->is_multicast());
  EXPECT_FALSE(Address::resolve("240.0.0.1:1")->is_multicast());
  EXPECT_FALSE(Address::loopback(1).is_multicast());
  EXPECT_TRUE(Address::resolve("[ff02::1]:1")->is_multicast());
  EXPECT_EQ(Address::any_ipv4(5).to_string(), "0.0.0.0:5");
}

}  // namespace
}  // namespace dance
