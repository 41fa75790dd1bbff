// A house whose network changes while its programs run: the dance on the machine goes on, and each
// program that has the bus open prints one line for each change.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>

#include "tests/apps/bus/house_on_lan.h"

namespace dance {
namespace {

class BusAndNetwork : public HouseOnLan {
 protected:
  // The programs that have the bus open, but for those that need a display, a camera or sound.
  void open_programs() {
    open_house();
    start("dance-record", {"-o", folder_.path("evening.lcm")});
    start("dance-receive", {"--from", "vmc", "--guest", "carol"});
    start("dance-haptics", {"--guest", "bob", "--to", "osc"});
    start("dance-link", {"--listen-only"});
    for (const char* program : kPrograms)
      ASSERT_TRUE(wait_for([&] { return !talk_of(program).empty() || !all_run(); })) << program;
  }
  int lines_with(const std::string& program, const std::string& words) const {
    const std::string talk = talk_of(program);
    int lines = 0;
    for (std::size_t at = 0; (at = talk.find(words, at)) != std::string::npos; ++at) ++lines;
    return lines;
  }
  void expect_one_line_each(const std::string& change, const std::string& move) {
    const std::string words = "multicast has moved " + move;
    std::map<std::string, int> before;
    for (const char* program : kPrograms) before[program] = lines_with(program, words);
    ASSERT_EQ(lan_.machine.run(change).exit_code, 0) << change;
    for (const char* program : kPrograms) {
      EXPECT_TRUE(wait_for([&] { return lines_with(program, words) > before[program]; }))
          << program << ": " << talk_of(program);
      EXPECT_EQ(lines_with(program, words), before[program] + 1) << program;
    }
    EXPECT_TRUE(is_dance_going_on()) << change;
  }

  static constexpr std::array<const char*, 7> kPrograms{
      "dance-join",    "dance-salsa",   "dance-listen", "dance-record",
      "dance-receive", "dance-haptics", "dance-link"};
};

TEST_F(BusAndNetwork, TheDanceOfAMachineGoesOnWhenTheNetworkChanges) {
  ASSERT_NO_FATAL_FAILURE(open_programs());
  // Wi-Fi off, and on again.
  expect_one_line_each("ip link set lan0 down", "from lan0 to no device");
  expect_one_line_each("ip link set lan0 up && ip route add default via 10.9.8.2",
                       "from no device to lan0");
  // A VPN that forbids all other routes.
  expect_one_line_each("ip rule add prohibit priority 100", "from lan0 to no device");
  expect_one_line_each("ip rule del prohibit priority 100", "from no device to lan0");
  expect_one_line_each(
      "ip link add vpn0 type veth peer name vpn0-far && ip link set vpn0-far up && ip addr add "
      "10.77.0.1/24 dev vpn0 && "
      "ip link set vpn0 up && ip route add 224.0.0.0/4 dev vpn0",
      "from lan0 to vpn0");
  expect_one_line_each("ip link del vpn0", "from vpn0 to lan0");
}

}  // namespace
}  // namespace dance
