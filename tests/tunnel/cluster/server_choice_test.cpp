#include "tunnel/link/failover/server_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace dance {
namespace {

Address server(std::uint16_t number) {
  return Address::loopback(static_cast<std::uint16_t>(7400 + number));
}

wire::ServerList list(std::initializer_list<std::uint16_t> numbers) {
  wire::ServerList servers;
  for (const std::uint16_t number : numbers)
    if (!servers.try_push(server(number))) std::abort();
  return servers;
}

const MonoTime kListedAt = MonoTime::from_us(1'000'000);

// A link that is connected to server 0, which lists the others. All have answered a probe.
struct ListedServers {
  explicit ListedServers(std::initializer_list<std::uint16_t> others) {
    choice.set_current(server(0));
    EXPECT_TRUE(choice.set_others(candidates.accept(server(0), list(others), kListedAt)));
    for (const std::uint16_t number : others) candidates.note_answer(server(number));
  }
  std::optional<Address> choose(const std::vector<ServerChoice::Distance>& distances) {
    choice.set_distances(distances);
    return choice.choose();
  }
  std::optional<Address> next(bool has_goodbye, MonoTime now) {
    return choice.next(has_goodbye, candidates, now);
  }

  ServerCandidates candidates;
  ServerChoice choice;
};

TEST(ServerChoice, TakesAServerThatIsNearerByMuchAndNoOther) {
  const auto chosen = [](double here_ms, std::optional<double> there_ms) {
    ListedServers choice({1});
    std::optional<Duration> there;
    if (there_ms) there = Duration::seconds(*there_ms * 1e-3);
    return choice.choose({{server(0), Duration::seconds(here_ms * 1e-3)}, {server(1), there}})
        .has_value();
  };
  EXPECT_TRUE(chosen(80.0, 10.0));
  EXPECT_FALSE(chosen(80.0, 70.0)) << "nearly the same";
  EXPECT_FALSE(chosen(4.0, 0.5)) << "nobody would notice";
  EXPECT_FALSE(chosen(80.0, std::nullopt)) << "it does not answer";
  EXPECT_FALSE(chosen(10.0, 80.0));
}

TEST(ServerChoice, DoesNotWanderLater) {
  ListedServers choice({1});
  const auto distances = [](int here_ms, int there_ms) {
    return std::vector<ServerChoice::Distance>{{server(0), Duration::ms(here_ms)},
                                               {server(1), Duration::ms(there_ms)}};
  };
  EXPECT_FALSE(choice.choose(distances(20, 20)));
  EXPECT_FALSE(choice.choose(distances(200, 20)));
}

TEST(ServerChoice, ChoosesInTheRoundThatMeasuresTheOthers) {
  ListedServers choice({1});
  EXPECT_FALSE(choice.choose({{server(0), Duration::ms(80)}, {server(1), {}}}));
  EXPECT_EQ(choice.choose({{server(0), Duration::ms(80)}, {server(1), Duration::ms(10)}}),
            server(1));
}

TEST(ServerChoice, KeepsADistanceWhenALaterProbeIsLost) {
  ListedServers choice({1, 2});
  EXPECT_FALSE(choice.choose({{server(0), Duration::ms(1)},
                              {server(1), Duration::ms(90)},
                              {server(2), Duration::ms(20)}}));
  choice.choice.set_distances({{server(0), {}}, {server(1), Duration::ms(90)}, {server(2), {}}});
  EXPECT_EQ(choice.next(true, kListedAt), server(2));
}

TEST(ServerChoice, AfterAGoodbyeGoesAtOnceAndInALapseSoon) {
  ListedServers left({1});
  EXPECT_EQ(left.next(true, kListedAt), server(1));
  ListedServers silent({1});
  EXPECT_FALSE(silent.next(false, kListedAt)) << "a short cut is over soon";
  EXPECT_FALSE(silent.next(false, kListedAt + Duration::ms(150)));
  EXPECT_EQ(silent.next(false, kListedAt + Duration::ms(200)), server(1));
}

TEST(ServerChoice, TriesTheNearestFirstAndAllInTurn) {
  ListedServers choice({1, 2, 3});
  EXPECT_FALSE(choice.choose({{server(0), Duration::ms(1)},
                              {server(1), Duration::ms(90)},
                              {server(2), Duration::ms(20)}}));  // 3 was not measured
  std::vector<Address> tried;
  for (MonoTime now = kListedAt; now - kListedAt < Duration::s(5); now += Duration::ms(1))
    if (const auto next = choice.next(true, now)) tried.push_back(*next);
  ASSERT_GE(tried.size(), 5u);
  EXPECT_EQ(std::vector(tried.begin(), tried.begin() + 5),
            (std::vector{server(2), server(1), server(3), server(0), server(2)}));
}

// A server that lists a victim and says goodbye.
TEST(ServerChoice, NeverGoesToACandidateThatHasNotAnsweredAProbe) {
  ServerChoice choice;
  ServerCandidates candidates;
  choice.set_current(server(0));
  ASSERT_TRUE(choice.set_others(candidates.accept(server(0), list({1, 2}), kListedAt)));
  int turns = 0;
  for (MonoTime now = kListedAt; now - kListedAt < Duration::s(60); now += Duration::ms(1)) {
    ASSERT_FALSE(choice.next(true, candidates, now));
    EXPECT_GT(choice.next_deadline(), now) << "it waits, and does not spin";
    ++turns;
  }
  EXPECT_EQ(turns, 60'000);
  candidates.note_answer(server(2));
  EXPECT_EQ(choice.next(true, candidates, kListedAt + Duration::s(61)), server(2));
}

// A goodbye in each welcome: the link goes to and fro between the liar and a server that answers
// probes but does not welcome the link.
TEST(ServerChoice, AServerThatSaysGoodbyeAgainAndAgainSendsALinkElsewhereSeldom) {
  ListedServers choice({1});
  int away = 0;
  for (MonoTime now = kListedAt; now - kListedAt < Duration::s(100); now += Duration::ms(10)) {
    const auto to = choice.next(true, now);
    if (to == server(1)) ++away;
    if (to == server(0)) choice.choice.end_lapse();
  }
  EXPECT_GE(away, 3);
  EXPECT_LE(away, 3 + 10);
}

TEST(ServerChoice, GivesASlowWayTheTimeItTakes) {
  ListedServers choice({1});
  EXPECT_FALSE(choice.choose({{server(0), Duration::ms(600)}, {server(1), Duration::ms(620)}}));
  MonoTime now = kListedAt;
  EXPECT_EQ(choice.next(true, now), server(1));
  // Eight round trips, and after each round of all servers twice as long.
  EXPECT_FALSE(choice.next(true, now + Duration::ms(4900)));
  now += Duration::ms(4960);
  EXPECT_EQ(choice.next(true, now), server(0));
  EXPECT_FALSE(choice.next(true, now + Duration::ms(4700)));
  now += Duration::ms(9700);
  EXPECT_EQ(choice.next(true, now), server(1));
}

TEST(ServerChoice, AServerGoneToByChoiceHasItsTimeToo) {
  ListedServers choice({1});
  choice.choice.begin_try(server(1), kListedAt);
  EXPECT_FALSE(choice.next(false, kListedAt + Duration::ms(300)));
  EXPECT_FALSE(choice.next(false, kListedAt + Duration::ms(700)));
  EXPECT_EQ(choice.next(false, kListedAt + Duration::ms(900)), server(0)) << "back where it was";
}

TEST(ServerChoice, LooksForANearerOneAgainAfterItHadToMove) {
  ListedServers choice({1});
  EXPECT_FALSE(choice.choose({{server(0), Duration::ms(10)}, {server(1), Duration::ms(90)}}));
  EXPECT_FALSE(choice.choice.end_lapse()) << "there was none";
  EXPECT_EQ(choice.next(true, kListedAt), server(1));
  EXPECT_TRUE(choice.choice.end_lapse());
  EXPECT_FALSE(choice.choice.end_lapse());
  EXPECT_EQ(choice.choose({{server(1), Duration::ms(90)}, {server(0), Duration::ms(10)}}),
            server(0));
}

TEST(ServerChoice, AServerThatStandsAloneIsWaitedFor) {
  ServerChoice choice;
  ServerCandidates candidates;
  choice.set_current(server(0));
  EXPECT_FALSE(choice.set_others({}));
  EXPECT_FALSE(choice.next(true, candidates, kListedAt));
  EXPECT_FALSE(choice.next_deadline().is_set());
}

TEST(ServerList, ReadsWhatItWrites) {
  wire::ServerList servers = list({1, 2});
  const std::array<std::uint8_t, 16> six{0x20, 1, 0xd, 0xb8};
  ASSERT_TRUE(servers.try_push(Address::of(six, 7400)));
  std::array<std::uint8_t, 400> bytes;
  const std::size_t size = wire::build(servers, bytes);
  const auto opening = wire::parse_opening({bytes.data(), size});
  ASSERT_TRUE(opening);
  EXPECT_EQ(opening->type, wire::Type::kServers);
  const auto read = wire::parse_servers(opening->body);
  ASSERT_TRUE(read);
  EXPECT_TRUE(std::ranges::equal(*read, servers));
  // Golden: type, how many; 4, address, port; …
  EXPECT_TRUE(std::ranges::equal(std::span(bytes).first(9),
                                 std::array<std::uint8_t, 9>{29, 3, 4, 127, 0, 0, 1, 0xe9, 0x1c}));
  for (std::size_t cut = 0; cut < opening->body.size(); ++cut)
    EXPECT_FALSE(wire::parse_servers(opening->body.first(cut)));
}

TEST(ServerList, RefusesWhatNobodyCanBeReachedAt) {
  const auto parse = [](std::vector<std::uint8_t> body) { return wire::parse_servers(body); };
  EXPECT_TRUE(parse({0}));
  EXPECT_TRUE(parse({1, 4, 10, 0, 0, 1, 1, 0}));
  EXPECT_FALSE(parse({1, 4, 10, 0, 0, 1, 0, 0})) << "port 0";
  EXPECT_FALSE(parse({1, 4, 224, 0, 0, 1, 1, 0})) << "a group";
  EXPECT_FALSE(parse({1, 5, 10, 0, 0, 1, 1, 0})) << "no such family";
  EXPECT_FALSE(parse({1, 0})) << "not set";
  EXPECT_FALSE(parse({1, 4, 10, 0, 0, 1, 1, 0, 9})) << "more than it says";
  EXPECT_FALSE(parse({17})) << "too many";
}

}  // namespace
}  // namespace dance
