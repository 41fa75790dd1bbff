#include "apps/doctor/doctor_network.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/net/udp_socket.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

using Grade = Finding::Grade;
using Outcome = ResolverAnswer::Outcome;

TEST(DoctorNetwork, ReportsLoopbackThatIsDownOrWithoutAddressAsAProblem) {
  EXPECT_EQ(check_loopback({true, true}).grade, Grade::kOk);
  EXPECT_EQ(check_loopback({false, false}).grade, Grade::kProblem);
  EXPECT_EQ(check_loopback({false, true}).cure, "ip link set lo up");
  EXPECT_EQ(check_loopback({true, false}).grade, Grade::kProblem);
  EXPECT_EQ(check_loopback({true, false}).cure, "ip address add 127.0.0.1/8 dev lo");
}

TEST(DoctorNetwork, FindsTheDeviceOfLoopback) {
  const Loopback loopback = loopback_state();
  EXPECT_TRUE(loopback.is_up && loopback.has_address);
  EXPECT_EQ(device_towards(Address::loopback(9)), "lo");
  EXPECT_EQ(device_of(*Address::resolve("203.0.113.7:1")), "");
}

TEST(DoctorNetwork, DistinguishesATunnelFromACardByItsKind) {
  const TestFolder folder("doctor-devices");
  const auto device = [&](const std::string& name, const std::string& file, const char* content) {
    std::filesystem::create_directories(folder.path(name));
    std::ofstream(folder.path(name) + "/" + file) << content;
  };
  device("eth0", "type", "1\n");
  device("ppp0", "type", "512\n");  // a modem
  device("wg0", "type", "65534\n");
  device("tap0", "type", "1\n");
  device("tap0", "tun_flags", "0x1002\n");
  EXPECT_FALSE(is_vpn_device("eth0", folder.path()));
  EXPECT_FALSE(is_vpn_device("ppp0", folder.path()));
  EXPECT_TRUE(is_vpn_device("wg0", folder.path()));
  EXPECT_TRUE(is_vpn_device("tap0", folder.path()));
  EXPECT_FALSE(is_vpn_device("gone0", folder.path()));
  EXPECT_FALSE(is_vpn_device("", folder.path()));
}

TEST(DoctorNetwork, NotesThatTheInternetIsBehindAVpnOrNotThere) {
  EXPECT_EQ(check_internet_route("eth0", false).grade, Grade::kOk);
  const Finding vpn = check_internet_route("wg0", true);
  EXPECT_EQ(vpn.grade, Grade::kNote);
  EXPECT_NE(vpn.what.find("wg0, a VPN"), std::string::npos) << vpn.what;
  EXPECT_NE(vpn.cure.find("wg-quick down wg0"), std::string::npos) << vpn.cure;
  const Finding none = check_internet_route("", false);
  EXPECT_EQ(none.grade, Grade::kNote);
  EXPECT_FALSE(none.cure.empty());
}

TEST(DoctorNetwork, NamesAPortThatAnotherProgramTook) {
  EXPECT_EQ(check_input_ports({}).grade, Grade::kOk);
  const Finding taken = check_input_ports({{"vmc", 39539}, {"rokoko", 14043}});
  EXPECT_EQ(taken.grade, Grade::kNote);
  EXPECT_EQ(taken.what.rfind("port 39539 of vmc, port 14043 of rokoko: taken.", 0), 0u)
      << taken.what;
  EXPECT_EQ(taken.cure.rfind("ss -ulpn 'sport = :39539'", 0), 0u) << taken.cure;
  ASSERT_EQ(usual_input_ports().size(), 2u);
  EXPECT_EQ(usual_input_ports()[0].port, 39539);
  const auto other = UdpSocket::bind(Address::loopback(0));
  ASSERT_TRUE(other);
  EXPECT_TRUE(is_udp_port_taken(other->local_address().port()));
  const auto everywhere = UdpSocket::bind(Address::any_ipv4(0));
  ASSERT_TRUE(everywhere);
  EXPECT_TRUE(is_udp_port_taken(everywhere->local_address().port()));
}

TEST(DoctorNetwork, NotesThatIpv6IsOffOnLoopback) {
  EXPECT_EQ(check_ipv6_loopback(true).grade, Grade::kOk);
  const Finding off = check_ipv6_loopback(false);
  EXPECT_EQ(off.grade, Grade::kNote);
  EXPECT_NE(off.cure.find("127.0.0.1"), std::string::npos) << off.cure;
}

TEST(DoctorNetwork, FindsTheNameInTheServerOfASessionFile) {
  EXPECT_EQ(host_name_of("dance.example.org:7400"), "dance.example.org");
  EXPECT_EQ(host_name_of("dance.example.org"), "dance.example.org");
  for (const char* address : {"", "192.168.1.5:7400", "10.0.0.1", "[2001:db8::1]:7400", "::1"})
    EXPECT_EQ(host_name_of(address), "") << address;
}

TEST(DoctorNetwork, DistinguishesAnUnknownNameFromASilentResolver) {
  const auto judge = [](const char* name, Outcome outcome, Duration took, bool has_server = true) {
    return check_names({name, outcome, "Temporary failure", took}, has_server);
  };
  const Duration quick = Duration::ms(12);
  EXPECT_EQ(judge("a.example", Outcome::kFound, quick).grade, Grade::kOk);
  EXPECT_NE(judge("a.example", Outcome::kFound, quick).what.find("12 ms"), std::string::npos);
  EXPECT_EQ(judge("a.example", Outcome::kFound, Duration::ms(5020)).grade, Grade::kNote)
      << "the first of two nameservers is silent";
  EXPECT_EQ(judge(kNoSuchName, Outcome::kUnknown, quick).grade, Grade::kOk);
  const Finding unknown = judge("a.exampel", Outcome::kUnknown, quick);
  EXPECT_EQ(unknown.grade, Grade::kNote);
  EXPECT_EQ(unknown.cure, "getent hosts a.exampel   (is it spelt right?)");
  const Finding silent = judge("a.example", Outcome::kSilent, Duration::s(4));
  EXPECT_EQ(silent.grade, Grade::kNote);
  EXPECT_NE(silent.what.find("does not answer within 4000 ms"), std::string::npos) << silent.what;
  const Finding unreachable = judge(kNoSuchName, Outcome::kNoAnswer, quick);
  EXPECT_NE(unreachable.what.find("no nameserver can be reached (Temporary"), std::string::npos);
  const Finding none = judge(kNoSuchName, Outcome::kNoAnswer, quick, false);
  EXPECT_NE(none.what.find("resolv.conf names no nameserver"), std::string::npos) << none.what;
  for (const Finding& finding : {unknown, silent, unreachable, none})
    EXPECT_FALSE(finding.cure.empty()) << finding.what;
}

TEST(DoctorNetwork, LooksUpALocalName) {
  const ResolverAnswer lookup = look_up_name("localhost", Duration::s(60));
  EXPECT_EQ(lookup.outcome, Outcome::kFound) << lookup.reason;
}

TEST(DoctorNetwork, NotesAServerWithoutIpv6OnAMachineThatHasIt) {
  const std::vector<std::string> both{"192.168.1.7", "2001:db8::7"};
  const Finding alone = check_server_reach("0.0.0.0:7400", both);
  EXPECT_EQ(alone.grade, Grade::kNote);
  EXPECT_NE(alone.what.find("2001:db8::7"), std::string::npos) << alone.what;
  EXPECT_NE(alone.cure.find("--bind ::"), std::string::npos) << alone.cure;
  EXPECT_EQ(check_server_reach("0.0.0.0:7400", {"192.168.1.7"}).grade, Grade::kOk);
  EXPECT_EQ(check_server_reach("[::]:7400", both).grade, Grade::kOk);
  EXPECT_EQ(check_server_reach("127.0.0.1:7400", both).grade, Grade::kOk)
      << "of this machine alone";
}

}  // namespace
}  // namespace dance
