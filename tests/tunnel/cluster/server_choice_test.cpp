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

ServerChoice choice_of(std::initializer_list<std::uint16_t> others) {
  ServerChoice choice;
  choice.set_current(server(0));
  EXPECT_TRUE(choice.set_others(list(others)));
  return choice;
}

TEST(ServerChoice, TakesAServerThatIsNearerByMuchAndNoOther) {
  const auto chosen = [](double here_ms, std::optional<double> there_ms) {
    ServerChoice choice = choice_of({1});
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
  ServerChoice choice = choice_of({1});
  const auto distances = [](int here_ms, int there_ms) {
    return std::vector<ServerChoice::Distance>{{server(0), Duration::ms(here_ms)},
                                               {server(1), Duration::ms(there_ms)}};
  };
  EXPECT_FALSE(choice.choose(distances(20, 20)));
  EXPECT_FALSE(choice.choose(distances(200, 20)));
}

TEST(ServerChoice, AfterAGoodbyeGoesAtOnceAndInALapseSoon) {
  const MonoTime now = MonoTime::from_us(1'000'000);
  ServerChoice left = choice_of({1});
  EXPECT_EQ(left.next(true, now), server(1));
  ServerChoice silent = choice_of({1});
  EXPECT_FALSE(silent.next(false, now)) << "a short cut is over soon";
  EXPECT_FALSE(silent.next(false, now + Duration::ms(150)));
  EXPECT_EQ(silent.next(false, now + Duration::ms(200)), server(1));
}

TEST(ServerChoice, TriesTheNearestFirstAndAllInTurn) {
  ServerChoice choice = choice_of({1, 2, 3});
  EXPECT_FALSE(choice.choose({{server(0), Duration::ms(1)},
                              {server(1), Duration::ms(90)},
                              {server(2), Duration::ms(20)}}));  // 3 does not answer
  MonoTime now = MonoTime::from_us(1'000'000);
  std::vector<Address> tried;
  for (int i = 0; i < 5000; ++i, now += Duration::ms(1))
    if (const auto next = choice.next(true, now)) tried.push_back(*next);
  ASSERT_GE(tried.size(), 5u);
  EXPECT_EQ(std::vector(tried.begin(), tried.begin() + 5),
            (std::vector{server(2), server(1), server(3), server(0), server(2)}));
}

TEST(ServerChoice, GivesASlowWayTheTimeItTakes) {
  ServerChoice choice = choice_of({1});
  EXPECT_FALSE(choice.choose({{server(0), Duration::ms(600)}, {server(1), Duration::ms(620)}}));
  MonoTime now = MonoTime::from_us(1'000'000);
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
  ServerChoice choice = choice_of({1});
  MonoTime now = MonoTime::from_us(1'000'000);
  choice.set_current(server(1));
  choice.begin_try(now);
  EXPECT_FALSE(choice.next(false, now + Duration::ms(300)));
  EXPECT_FALSE(choice.next(false, now + Duration::ms(700)));
}

TEST(ServerChoice, LooksForANearerOneAgainAfterItHadToMove) {
  ServerChoice choice = choice_of({1});
  EXPECT_FALSE(choice.choose({{server(0), Duration::ms(10)}, {server(1), Duration::ms(90)}}));
  const MonoTime now = MonoTime::from_us(1'000'000);
  EXPECT_FALSE(choice.end_lapse()) << "there was none";
  EXPECT_EQ(choice.next(true, now), server(1));
  EXPECT_TRUE(choice.end_lapse());
  EXPECT_FALSE(choice.end_lapse());
  EXPECT_EQ(choice.choose({{server(1), Duration::ms(90)}, {server(0), Duration::ms(10)}}),
            server(0));
}

TEST(ServerChoice, AServerThatStandsAloneIsWaitedFor) {
  ServerChoice choice;
  choice.set_current(server(0));
  EXPECT_FALSE(choice.set_others({}));
  EXPECT_FALSE(choice.next(true, MonoTime::from_us(1'000'000)));
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
