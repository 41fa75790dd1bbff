// Files from house to house through a server, without sockets: loss, late comers, a server and
// houses that begin anew, one upload for all.
#include <gtest/gtest.h>

#include "tests/tunnel/files/test_file.h"

namespace dance {
namespace {

bool is_of(wire::Bytes bytes, wire::Type type) {
  const auto opening = wire::parse_opening(bytes);
  return opening && opening->type == type;
}

class Files : public ::testing::Test {
 protected:
  Files() { tunnel.link_options.file_bytes_per_second = 400'000.0; }
  void open(std::size_t receivers) {
    alice = &tunnel.add_house("salsa", {"alice"}, Duration::s(100));
    for (std::size_t i = 0; i < receivers; ++i)
      others.push_back(&tunnel.add_house("salsa", {"guest-" + std::to_string(i)},
                                         Duration::s(static_cast<std::int64_t>(7 * i))));
    tunnel.run(Duration::ms(500));
  }
  void fetch_all(const TestFile& file) {
    for (auto* house : others) fetch(tunnel, *house, "alice", file);
  }
  bool all_have(const TestFile& file) const {
    return std::ranges::all_of(others, [&](const auto* house) {
      const auto found = house->files.find(guest("alice"));
      return found != house->files.end() && found->second == file.bytes;
    });
  }
  void run_until_all_have(const TestFile& file, Duration most) {
    for (Duration t; t < most && !all_have(file); t += Duration::ms(100))
      tunnel.run(Duration::ms(100));
  }

  SimulatedTunnel tunnel;
  SimulatedTunnel::House* alice = nullptr;
  std::vector<SimulatedTunnel::House*> others;
};

TEST_F(Files, TheStateArrivesAndThenTheFileByteForByte) {
  open(1);
  const TestFile file = test_file(123'456);
  choose(tunnel, *alice, "alice", file);
  tunnel.run(Duration::ms(200));
  ASSERT_TRUE(others[0]->avatar_files.contains(guest("alice")));
  EXPECT_EQ(others[0]->avatar_files.at(guest("alice")).hash, file.hash);
  fetch_all(file);
  run_until_all_have(file, Duration::s(5));
  EXPECT_TRUE(all_have(file));
}

TEST_F(Files, TenReceiversCostTheSenderOneUpload) {
  open(10);
  const TestFile file = test_file(200'000);
  choose(tunnel, *alice, "alice", file);
  std::size_t up = 0, down = 0;
  tunnel.on_datagram = [&](bool to_server, PeerId, wire::Bytes bytes) {
    if (is_of(bytes, wire::Type::kFileChunk)) ++(to_server ? up : down);
    return true;
  };
  tunnel.run(Duration::ms(200));
  fetch_all(file);
  run_until_all_have(file, Duration::s(10));
  EXPECT_TRUE(all_have(file));
  EXPECT_EQ(up, wire::chunks_of(file.size()));
  EXPECT_EQ(down, 10 * wire::chunks_of(file.size()));
}

TEST_F(Files, LateComersGetItFromTheServer) {
  open(1);
  const TestFile file = test_file(100'000);
  choose(tunnel, *alice, "alice", file);
  tunnel.run(Duration::ms(200));
  fetch_all(file);
  run_until_all_have(file, Duration::s(5));
  ASSERT_TRUE(all_have(file));
  const auto sent = alice->link->files().sent().chunks_sent;
  others.push_back(&tunnel.add_house("salsa", {"late"}));
  tunnel.run(Duration::ms(500));
  EXPECT_TRUE(others.back()->avatar_files.contains(guest("alice")));
  fetch(tunnel, *others.back(), "alice", file);
  run_until_all_have(file, Duration::s(5));
  EXPECT_TRUE(all_have(file));
  EXPECT_EQ(alice->link->files().sent().chunks_sent, sent);
}

TEST_F(Files, LossIsMadeGood) {
  for (const double loss : {0.05, 0.25}) {
    SimulatedTunnel lossy;
    lossy.link_options.file_bytes_per_second = 400'000.0;
    auto& a = lossy.add_house("salsa", {"alice"});
    auto& b = lossy.add_house("salsa", {"bob"});
    lossy.run(Duration::ms(500));
    Random random(5);
    lossy.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
      const auto type = wire::parse_opening(bytes)->type;
      return type < wire::Type::kFileWant || random.uniform() >= loss;
    };
    const TestFile file = test_file(100'000);
    choose(lossy, a, "alice", file);
    lossy.run(Duration::ms(500));
    fetch(lossy, b, "alice", file);
    lossy.run(Duration::s(120));
    EXPECT_EQ(b.files[guest("alice")], file.bytes) << loss;
  }
}

TEST_F(Files, AServerThatIsKilledMidwayCostsOnlyTime) {
  open(2);
  const TestFile file = test_file(300'000);
  choose(tunnel, *alice, "alice", file);
  tunnel.run(Duration::ms(200));
  fetch_all(file);
  tunnel.run(Duration::ms(400));
  const auto before = others[0]->link->files().received().chunks_taken;
  EXPECT_GT(before, 50u);
  EXPECT_FALSE(all_have(file));
  tunnel.stop_server();
  tunnel.run(Duration::s(3));
  tunnel.start_server();
  run_until_all_have(file, Duration::s(20));
  EXPECT_TRUE(all_have(file));
  EXPECT_EQ(others[0]->link->files().received().chunks_taken, wire::chunks_of(file.size()))
      << "nothing was fetched twice";
}

TEST_F(Files, ALineThatIsCutForAWhileCostsOnlyTime) {
  open(1);
  const TestFile file = test_file(300'000);
  choose(tunnel, *alice, "alice", file);
  tunnel.run(Duration::ms(200));
  fetch_all(file);
  tunnel.run(Duration::ms(300));
  alice->is_cut = true;
  tunnel.run(Duration::s(6));
  EXPECT_FALSE(all_have(file));
  alice->is_cut = false;
  run_until_all_have(file, Duration::s(40));
  EXPECT_TRUE(all_have(file));
}

TEST_F(Files, ASenderThatBeginsAnewGoesOn) {
  open(1);
  const TestFile file = test_file(300'000);
  choose(tunnel, *alice, "alice", file);
  tunnel.run(Duration::ms(200));
  fetch_all(file);
  tunnel.run(Duration::ms(400));
  alice->link->send_goodbye();
  tunnel.run(Duration::s(1));
  tunnel.start_link(*alice, "salsa", {"alice"});
  tunnel.run(Duration::ms(500));
  choose(tunnel, *alice, "alice", file);
  run_until_all_have(file, Duration::s(40));
  EXPECT_TRUE(all_have(file));
  EXPECT_EQ(others[0]->link->files().received().chunks_taken, wire::chunks_of(file.size()));
}

TEST_F(Files, ANewChoiceTakesThePlaceOfTheOld) {
  open(1);
  const TestFile first = test_file(400'000, 3), second = test_file(80'000, 5);
  choose(tunnel, *alice, "alice", first);
  tunnel.run(Duration::ms(200));
  fetch_all(first);
  tunnel.run(Duration::ms(200));
  choose(tunnel, *alice, "alice", second);
  tunnel.run(Duration::ms(200));
  EXPECT_EQ(others[0]->avatar_files.at(guest("alice")).hash, second.hash);
  fetch_all(second);
  run_until_all_have(second, Duration::s(10));
  EXPECT_TRUE(all_have(second));
}

TEST_F(Files, WhatIsNotOfferedIsRefused) {
  open(1);
  const TestFile file = test_file(50'000);
  fetch_all(file);  // nobody has chosen it
  tunnel.run(Duration::s(1));
  ASSERT_FALSE(others[0]->file_refusals.empty());
  EXPECT_EQ(others[0]->file_refusals[0],
            std::pair(guest("alice"), wire::FileRefusalCause::kNotOffered));
}

TEST_F(Files, RateNoughtNeitherSendsNorFetches) {
  tunnel.link_options.file_bytes_per_second = 0.0;
  auto& mute = tunnel.add_house("salsa", {"mute"});
  tunnel.link_options.file_bytes_per_second = 400'000.0;
  open(1);
  const TestFile file = test_file(50'000, 3), hers = test_file(50'000, 5);
  choose(tunnel, mute, "mute", file);
  choose(tunnel, *alice, "alice", hers);
  std::size_t chunks = 0;
  tunnel.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
    if (is_of(bytes, wire::Type::kFileChunk)) ++chunks;
    return true;
  };
  tunnel.run(Duration::ms(500));
  EXPECT_TRUE(others[0]->avatar_files.contains(guest("mute"))) << "the choice is told";
  fetch(tunnel, *others[0], "mute", file);
  fetch(tunnel, mute, "alice", hers);
  tunnel.run(Duration::s(3));
  EXPECT_EQ(chunks, 0u);
  ASSERT_FALSE(others[0]->file_refusals.empty());
  EXPECT_EQ(others[0]->file_refusals[0].second, wire::FileRefusalCause::kNoFiles);
}

TEST_F(Files, AreForgottenWithTheirGuestAndRoom) {
  open(1);
  const TestFile file = test_file(50'000);
  choose(tunnel, *alice, "alice", file);
  tunnel.run(Duration::ms(200));
  fetch_all(file);
  run_until_all_have(file, Duration::s(5));
  EXPECT_EQ(tunnel.server().files().count(), 1u);
  EXPECT_EQ(tunnel.server().files().size_bytes(), file.size());
  alice->link->send_goodbye();
  tunnel.run(Duration::s(1));
  EXPECT_EQ(tunnel.server().files().count(), 0u);
  EXPECT_EQ(tunnel.server().files().size_bytes(), 0u);
}

TEST(FilesOfOldPeers, DoNotReachThemAndDoNotDisturb) {
  // A server before these records: it knows neither terms nor the state.
  ServerLimits limits;
  limits.file_bytes = 0;
  SimulatedTunnel tunnel(limits);
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  std::size_t terms = 0, others = 0, states = 0;
  tunnel.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
    const auto type = wire::parse_opening(bytes)->type;
    if (type == wire::Type::kFileTerms) ++terms;
    if (type > wire::Type::kFileTerms && type <= wire::Type::kFileRefusal) ++others;
    if (type == wire::Type::kState && (bytes[1] & 15) == 8) ++states;
    return true;
  };
  const TestFile file = test_file(50'000);
  tunnel.run(Duration::ms(200));
  choose(tunnel, a, "alice", file);
  a.link->send(guest("alice"), Avatar(), tunnel.time_in(a));
  fetch(tunnel, b, "alice", file);
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(10));
  EXPECT_LE(terms, 12u) << "each link tries a few times and leaves it";
  EXPECT_EQ(others, 0u);
  EXPECT_EQ(states, 0u);
  EXPECT_TRUE(b.avatars.contains(guest("alice"))) << "other states go on";
  EXPECT_GT(b.heard_of(guest("alice")), 500u);
}

TEST(FilesOfOldPeers, ALinkWithoutTermsIsToldNoneOfIt) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& old = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(1));
  bool has_unknown = false;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    if (peer != old.peer) return true;
    const auto type = wire::parse_opening(bytes)->type;
    if (to_server && type == wire::Type::kFileTerms) return false;  // it would not say so
    const bool is_new_state = type == wire::Type::kState && (bytes[1] & 15) == 8;
    const bool is_new = type >= wire::Type::kFileTerms && type <= wire::Type::kFileRefusal;
    has_unknown = has_unknown || (!to_server && (is_new || is_new_state));
    return true;
  };
  tunnel.run(Duration::ms(500));
  const TestFile file = test_file(50'000);
  choose(tunnel, a, "alice", file);
  a.link->send(guest("alice"), Avatar(), tunnel.time_in(a));
  tunnel.run(Duration::s(3));
  EXPECT_FALSE(has_unknown);
  EXPECT_TRUE(old.avatars.contains(guest("alice")));
  EXPECT_FALSE(old.avatar_files.contains(guest("alice")));
}

}  // namespace
}  // namespace dance
