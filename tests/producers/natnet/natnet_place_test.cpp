#include "producers/natnet/natnet_place.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(NatNetPlace, WithoutAnyItIsMotivesUsualGroup) {
  const auto place = parse_natnet_place("");
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->listen.to_string(), "239.255.42.99:1511");
  EXPECT_TRUE(place->listen.is_multicast());
  EXPECT_FALSE(place->interface.is_set());
  EXPECT_FALSE(place->server.is_set());
  EXPECT_FALSE(place->version.has_value());
}

TEST(NatNetPlace, NamesInterfaceServerVersionAndUpAxis) {
  const auto group = parse_natnet_place("239.255.42.99?interface=192.168.1.20&version=3.1&up=z");
  ASSERT_TRUE(group.has_value()) << group.error().what;
  EXPECT_EQ(group->listen.port(), 1511);
  EXPECT_EQ(group->interface.with_port(0).to_string(), "192.168.1.20:0");
  EXPECT_EQ(group->version, (NatNetVersion{3, 1}));
  EXPECT_TRUE(group->z_is_up);
  const auto unicast = parse_natnet_place("0.0.0.0:1511?server=192.168.1.5");
  ASSERT_TRUE(unicast.has_value()) << unicast.error().what;
  EXPECT_EQ(unicast->server.to_string(), "192.168.1.5:1510");
}

TEST(NatNetPlace, WhatIsWrongIsNamed) {
  for (const char* text :
       {"239.255.42.99:1511?", "239.255.42.99?interface", "239.255.42.99?port=3",
        "239.255.42.99?version=2.9", "239.255.42.99?up=x", "127.0.0.1:1511?interface=127.0.0.1",
        "239.255.42.99?interface=[::1]", "nowhere:port"})
    EXPECT_FALSE(parse_natnet_place(text).has_value()) << text;
}

}  // namespace
}  // namespace dance
