// Tests the choice of the device for multicast from the kernel's table.
#include "core/bus/route/multicast_route.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

// As /proc/net/route prints them on a little-endian machine.
constexpr const char* kHead =
    "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\t\tMTU\tWindow\tIRTT\n";
constexpr const char* kDefaultOnEth0 =
    "eth0\t00000000\t010011AC\t0003\t0\t0\t0\t00000000\t0\t0\t0\n";
constexpr const char* kLanOnEth0 = "eth0\t000011AC\t00000000\t0001\t0\t0\t0\t0000FFFF\t0\t0\t0\n";
constexpr const char* kMulticastOnLo = "lo\t000000E0\t00000000\t0001\t0\t0\t0\t000000F0\t0\t0\t0\n";
constexpr const char* kDownMulticastOnLo =
    "lo\t000000E0\t00000000\t0000\t0\t0\t0\t000000F0\t0\t0\t0\n";
constexpr const char* kGroup = "239.255.76.67";

std::string device(const std::string& rows) {
  return multicast_device(kGroup, std::string(kHead) + rows);
}

TEST(MulticastRoute, LoopbackRouteWinsOverTheDefaultRoute) {
  EXPECT_EQ(device(std::string(kDefaultOnEth0) + kLanOnEth0 + kMulticastOnLo), "lo");
  EXPECT_EQ(device(std::string(kMulticastOnLo) + kDefaultOnEth0), "lo");
}

TEST(MulticastRoute, WithoutOneTheDefaultRouteCarriesTheBus) {
  EXPECT_EQ(device(std::string(kDefaultOnEth0) + kLanOnEth0), "eth0");
}

TEST(MulticastRoute, NoRouteIsNoDevice) {
  EXPECT_EQ(device(""), "");
  EXPECT_EQ(device(kLanOnEth0), "");
  EXPECT_EQ(multicast_device(kGroup, ""), "");
}

TEST(MulticastRoute, ARouteThatIsNotUpDoesNotCount) { EXPECT_EQ(device(kDownMulticastOnLo), ""); }

TEST(MulticastRoute, RowsThatMakeNoSenseAreReadOver) {
  EXPECT_EQ(device(std::string("lo\n\nlo\tzzz\t0\t1\n") + kMulticastOnLo), "lo");
  EXPECT_EQ(device("lo 000000E0 00000000 0001 0 0\n"), "");
}

TEST(MulticastRoute, AGroupThatIsNoAddressHasNoDevice) {
  for (const char* group : {"", "239.255.76", "239.255.76.67.1", "239.255.76.256", "nobody"})
    EXPECT_EQ(multicast_device(group, std::string(kHead) + kMulticastOnLo), "") << group;
}

}  // namespace
}  // namespace dance
