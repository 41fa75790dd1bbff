// Tests which listed servers a link probes and connects to.
#include "tunnel/link/failover/server_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace dance {
namespace {

Address public_address(const std::string& text) { return *Address::resolve(text, 7400); }
wire::ServerList list(const std::vector<std::string>& texts) {
  wire::ServerList servers;
  for (const std::string& text : texts)
    if (!servers.try_push(public_address(text))) std::abort();
  return servers;
}
const MonoTime kStart = MonoTime::from_us(1'000'000);

TEST(AddressScope, ClassifiesAddressesByTheNetworksThatReachThem) {
  const std::vector<std::pair<const char*, Address::Scope>> expected{
      {"127.0.0.1", Address::Scope::kMachine},
      {"[::1]", Address::Scope::kMachine},
      {"169.254.1.1", Address::Scope::kLink},
      {"[fe80::1]", Address::Scope::kLink},
      {"10.1.2.3", Address::Scope::kPrivate},
      {"172.16.0.1", Address::Scope::kPrivate},
      {"172.31.255.1", Address::Scope::kPrivate},
      {"192.168.1.1", Address::Scope::kPrivate},
      {"100.64.0.1", Address::Scope::kPrivate},
      {"[fd00::1]", Address::Scope::kPrivate},
      {"[64:ff9b::a00:1]", Address::Scope::kPrivate},
      {"[2002:c0a8:101::1]", Address::Scope::kPrivate},
      {"172.32.0.1", Address::Scope::kInternet},
      {"100.128.0.1", Address::Scope::kInternet},
      {"8.8.4.4", Address::Scope::kInternet},
      {"[2001:db8::1]", Address::Scope::kInternet},
      {"[64:ff9b::808:404]", Address::Scope::kInternet},
      {"0.0.0.0", Address::Scope::kNone},
      {"255.255.255.255", Address::Scope::kNone},
      {"224.0.0.1", Address::Scope::kNone},
      {"[::]", Address::Scope::kNone},
      {"[ff02::1]", Address::Scope::kNone}};
  for (const auto& [text, scope] : expected) EXPECT_EQ(public_address(text).scope(), scope) << text;
}

TEST(ServerCandidates, APublicServerCannotNameHostsOfThisNetwork) {
  ServerCandidates candidates;
  const auto taken =
      candidates.accept(public_address("203.0.113.5"),
                        list({"127.0.0.1", "192.168.1.1", "10.0.0.1", "169.254.169.254",
                              "[fd00::1]", "0.0.0.0", "[64:ff9b::c0a8:101]", "198.51.100.7"}),
                        kStart);
  EXPECT_TRUE(std::ranges::equal(taken, list({"198.51.100.7"})));
  EXPECT_EQ(candidates.counters().of(ServerCandidates::Verdict::kNotReachable), 7u);
}

TEST(ServerCandidates, AServerOfThisNetworkMayNameOthersOfIt) {
  ServerCandidates lan, machine;
  EXPECT_EQ(lan.accept(public_address("192.168.1.2"),
                       list({"192.168.1.3", "127.0.0.1", "198.51.100.7"}), kStart)
                .size(),
            2u);
  EXPECT_EQ(
      machine.accept(public_address("127.0.0.1"), list({"127.0.0.1:7401", "192.168.1.3"}), kStart)
          .size(),
      2u);
}

// An attack: lists that name 1,000 ports of a third host, one after the other.
TEST(ServerCandidates, ThousandPortsOfAThirdHostAreNeverCandidates) {
  ServerCandidates candidates;
  std::set<std::uint16_t> ports;
  MonoTime now = kStart;
  for (int first = 1; first <= 1000; first += 16, now += Duration::ms(100)) {
    wire::ServerList named;
    for (int i = 0; i < 16; ++i)
      (void)named.try_push(
          public_address("198.51.100.7").with_port(static_cast<std::uint16_t>(first + i)));
    for (const Address& taken : candidates.accept(public_address("203.0.113.5"), named, now))
      ports.insert(taken.port());
  }
  EXPECT_EQ(ports.size(), ServerCandidates::kPortsPerHost);
}

TEST(ServerCandidates, DifferentHostsAreBoundedWithinTheWindow) {
  ServerCandidates candidates;
  const auto name = [&](int number, MonoTime now) {
    return candidates
        .accept(public_address("203.0.113.5"), list({"198.51.100." + std::to_string(number)}), now)
        .size();
  };
  std::size_t taken = 0;
  for (int i = 1; i <= 200; ++i) taken += name(i, kStart + Duration::s(i));
  EXPECT_EQ(taken, ServerCandidates::kMost);
  EXPECT_EQ(name(1, kStart + Duration::s(300)), 1u) << "known";
  // Hosts that no list named within the window are forgotten.
  const MonoTime later = kStart + Duration::s(300) + ServerCandidates::kWindow;
  EXPECT_EQ(name(201, later), 1u);
  EXPECT_EQ(name(1, later), 1u);
}

TEST(ServerCandidates, EachIsProbedOnceEachTenSeconds) {
  ServerCandidates candidates;
  const std::vector<Address> servers{public_address("198.51.100.1"),
                                     public_address("198.51.100.2")};
  EXPECT_EQ(candidates.probe_due(servers, kStart), kStart);
  candidates.note_probes(std::span(servers).first(1), kStart);
  const MonoTime soon = kStart + Duration::s(1);
  EXPECT_EQ(candidates.probe_due(servers, soon), kStart + ServerCandidates::kProbeEach);
  EXPECT_EQ(candidates.probe_due(std::span(servers).last(1), soon), soon);
  const MonoTime later = kStart + ServerCandidates::kProbeEach;
  EXPECT_EQ(candidates.probe_due(servers, later), later);
}

// An attack: a list that names a victim, and a goodbye.
TEST(ServerCandidates, AllowsNoTryOfACandidateThatHasNotAnsweredAProbe) {
  ServerCandidates candidates;
  const Address home = public_address("203.0.113.5"), victim = public_address("198.51.100.7");
  candidates.accept(home, list({"198.51.100.7"}), kStart);
  for (int s = 0; s < 600; ++s)
    ASSERT_FALSE(candidates.take_try(victim, kStart + Duration::s(s))) << s;
  candidates.note_answer(public_address("198.51.100.8"));
  EXPECT_FALSE(candidates.take_try(public_address("198.51.100.8"), kStart)) << "listed by nobody";
  candidates.note_answer(victim);
  EXPECT_TRUE(candidates.take_try(victim, kStart));
}

TEST(ServerCandidates, ACandidateThatDoesNotWelcomeTheLinkIsTriedOnceEachTenSeconds) {
  ServerCandidates candidates;
  const Address home = public_address("203.0.113.5"), other = public_address("198.51.100.7");
  candidates.accept(home, list({"198.51.100.7"}), kStart);
  candidates.note_answer(other);
  const auto tries_in = [&](MonoTime from, Duration duration) {
    int tries = 0;
    for (MonoTime now = from; now - from < duration; now += Duration::ms(100)) {
      // Each list names it again.
      candidates.accept(home, list({"198.51.100.7"}), now);
      candidates.note_answer(other);
      tries += candidates.take_try(other, now);
    }
    return tries;
  };
  EXPECT_EQ(tries_in(kStart, Duration::s(100)), 3 + 9);
  const MonoTime later = kStart + Duration::s(100);
  candidates.note_welcome(other);
  EXPECT_EQ(tries_in(later, Duration::s(5)), 3);
}

TEST(ServerCandidates, TheHomeServerStaysAChoiceWhateverListsName) {
  ServerCandidates candidates;
  const Address home = public_address("203.0.113.5"), other = public_address("198.51.100.1");
  candidates.accept(home, list({"198.51.100.1"}), kStart);
  candidates.note_answer(other);
  std::vector<std::string> full;
  for (int i = 1; i <= 16; ++i) full.push_back("198.51.100." + std::to_string(i));
  const auto taken = candidates.accept(other, list(full), kStart);
  EXPECT_EQ(taken.size(), wire::kMaxServers);
  EXPECT_TRUE(taken.contains(home));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(candidates.take_try(home, kStart));
}

// The server in use does not list itself, so its entry must not expire meanwhile.
TEST(ServerCandidates, TheServerInUseStaysKnown) {
  ServerCandidates candidates;
  const Address home = public_address("203.0.113.5"), other = public_address("198.51.100.7");
  candidates.accept(home, list({"198.51.100.7"}), kStart);
  candidates.note_answer(other);
  MonoTime now = kStart;
  for (; now - kStart < ServerCandidates::kWindow * 3; now += Duration::s(10))
    candidates.accept(other, list({"203.0.113.5"}), now);
  EXPECT_TRUE(candidates.has_answered(other));
  now += ServerCandidates::kWindow;
  candidates.accept(home, wire::ServerList(), now);
  EXPECT_FALSE(candidates.has_answered(other));
}

}  // namespace
}  // namespace dance
