#include "core/bus/bus_url.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(BusUrl, ReadsGroupPortAndOptions) {
  const auto address = parse_udpm_url("udpm://239.255.76.67:7667?ttl=0");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->group, "239.255.76.67");
  EXPECT_EQ(address->ip, 0xefff4c43u);
  EXPECT_EQ(address->port, 7667);
  EXPECT_EQ(address->ttl, 0);
  EXPECT_EQ(address->receive_buffer_bytes, 0);
  const auto open = parse_udpm_url("udpm://224.0.0.1:65535?recv_buf_size=4194304&ttl=255");
  ASSERT_TRUE(open) << open.error().what;
  EXPECT_EQ(open->ttl, 255);
  EXPECT_EQ(open->receive_buffer_bytes, 4194304);
}

TEST(BusUrl, StaysOnThisMachineWithoutATtl) {
  for (const char* url : {"udpm://224.0.0.1:65535", "udpm://224.0.0.1:1?", "udpm://224.0.0.1:1?&",
                          "udpm://224.0.0.1:1?transmit_only=true"}) {
    const auto address = parse_udpm_url(url);
    ASSERT_TRUE(address) << url;
    EXPECT_EQ(address->ttl, 0) << url;
  }
}

TEST(BusUrl, NamesWhatIsWrongAndTheCure) {
  const struct {
    const char* url;
    const char* why;
  } kCases[] = {
      {"", "only udpm://"},
      {"tcpq://localhost:7700", "only udpm://"},
      {"udpm://239.255.76.67", "no port"},
      {"udpm://10.0.0.1:7667", "224.0.0.0/4"},
      {"udpm://240.0.0.1:7667", "224.0.0.0/4"},
      {"udpm://:7667", "224.0.0.0/4"},
      {"udpm://239.255.76.67:", "port"},
      {"udpm://239.255.76.67:0", "port"},
      {"udpm://239.255.76.67:65536", "port"},
      {"udpm://239.255.76.67:99999999999", "port"},
      {"udpm://239.255.76.67:7667x", "port"},
      {"udpm://239.255.76.67:-1", "port"},
      {"udpm://239.255.76.67:7667?ttl", "ttl is not"},
      {"udpm://239.255.76.67:7667?ttl=", "ttl is not"},
      {"udpm://239.255.76.67:7667?ttl=256", "ttl is not"},
      {"udpm://239.255.76.67:7667?ttl=-1", "ttl is not"},
      {"udpm://239.255.76.67:7667?ttl=0x1", "ttl is not"},
      {"udpm://239.255.76.67:7667?ttl=0&recv_buf_size=much", "recv_buf_size is not"},
      {"udpm://239.255.76.67:7667?recv_buf_size=0", "recv_buf_size is not"},
      {"udpm://239.255.76.67:7667?recv_buf_size=99999999999", "recv_buf_size is not"},
      {"udpm://239.255.76.67:7667?tll=1", "unknown option 'tll'"},
      {"udpm://239.255.76.67:7667?\x1b[2J=1", "unknown option '?[2J'"},
  };
  for (const auto& c : kCases) {
    const auto address = parse_udpm_url(c.url);
    ASSERT_FALSE(address) << c.url;
    EXPECT_NE(address.error().what.find(c.why), std::string::npos) << address.error().what;
    EXPECT_NE(address.error().what.find("udpm://239.255.76.67:7667?ttl=0"), std::string::npos);
    EXPECT_EQ(address.error().what.find('\x1b'), std::string::npos);
  }
}

}  // namespace
}  // namespace dance
