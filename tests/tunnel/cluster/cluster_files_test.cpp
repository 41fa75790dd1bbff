// Files of avatars between servers: asked for at the server of the guest whose it is, once for all
// who want it there, and behind what cannot wait.
#include <gtest/gtest.h>

#include "tests/tunnel/cluster/simulated_cluster.h"
#include "tests/tunnel/files/test_file.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

class ClusterFiles : public ::testing::Test {
 protected:
  void open(std::size_t servers) {
    cluster.emplace(servers);
    for (std::size_t i = 0; i < servers; ++i)
      (*cluster)[i].tunnel.link_options.file_bytes_per_second = 400'000.0;
    alice = &(*cluster)[0].add("alice");
  }
  void choose_at(std::size_t site, House& house, const char* who, const TestFile& file) {
    choose((*cluster)[site].tunnel, house, who, file);
  }
  bool run_until(const std::function<bool()>& holds, Duration most) {
    for (Duration t; t < most && !holds(); t += Duration::ms(100)) cluster->run(Duration::ms(100));
    return holds();
  }
  static bool has(House& house, const TestFile& file) {
    const auto found = house.files.find(guest("alice"));
    return found != house.files.end() && found->second == file.bytes;
  }

  std::optional<SimulatedCluster> cluster;
  House* alice = nullptr;
};

TEST_F(ClusterFiles, AGuestAtAnotherServerGetsTheFileByteForByte) {
  open(2);
  House& bob = (*cluster)[1].add("bob");
  const TestFile file = test_file(123'456);
  choose_at(0, *alice, "alice", file);
  ASSERT_TRUE(run_until([&] { return bob.avatar_files.contains(guest("alice")); }, Duration::s(3)));
  fetch((*cluster)[1].tunnel, bob, "alice", file);
  EXPECT_TRUE(run_until([&] { return has(bob, file); }, Duration::s(10)));
  EXPECT_TRUE(bob.file_refusals.empty());
}

TEST_F(ClusterFiles, AllOfAServerCostTheSenderAndTheClusterOneTransfer) {
  open(3);
  std::vector<House*> others;
  for (int i = 0; i < 4; ++i)
    others.push_back(&(*cluster)[i < 2 ? 1u : 2u].add("guest-" + std::to_string(i)));
  const TestFile file = test_file(100'000);
  choose_at(0, *alice, "alice", file);
  cluster->run(Duration::ms(500));
  (*cluster)[0].published.clear();
  for (std::size_t i = 0; i < others.size(); ++i)
    fetch((*cluster)[i < 2 ? 1u : 2u].tunnel, *others[i], "alice", file);
  EXPECT_TRUE(run_until(
      [&] { return std::ranges::all_of(others, [&](auto* it) { return has(*it, file); }); },
      Duration::s(20)));
  const std::size_t chunks = wire::chunks_of(file.size());
  EXPECT_EQ(alice->link->files().sent().chunks_sent, chunks);
  EXPECT_EQ((*cluster)[0].tunnel.server().counters().file_chunks_out, 2 * chunks)
      << "once to each server";
}

TEST_F(ClusterFiles, WhatIsNotOfferedIsRefusedAtOnce) {
  open(2);
  House& bob = (*cluster)[1].add("bob");
  const TestFile file = test_file(5000), another = test_file(5000, 9);
  choose_at(0, *alice, "alice", file);
  ASSERT_TRUE(run_until([&] { return bob.avatar_files.contains(guest("alice")); }, Duration::s(3)));
  fetch((*cluster)[1].tunnel, bob, "alice", another);
  EXPECT_TRUE(run_until([&] { return !bob.file_refusals.empty(); }, Duration::s(5)));
  // The house no longer has it: its own refusal comes all the way.
  bob.file_refusals.clear();
  alice->link->files().offer(guest("alice"), file.hash, nullptr);
  fetch((*cluster)[1].tunnel, bob, "alice", file);
  EXPECT_TRUE(run_until([&] { return !bob.file_refusals.empty(); }, Duration::s(5)));
  EXPECT_FALSE(has(bob, file));
}

TEST_F(ClusterFiles, ItGoesOnWhenServersWereCutOffMeanwhile) {
  open(2);
  House& bob = (*cluster)[1].add("bob");
  const TestFile file = test_file(300'000);
  choose_at(0, *alice, "alice", file);
  ASSERT_TRUE(run_until([&] { return bob.avatar_files.contains(guest("alice")); }, Duration::s(3)));
  fetch((*cluster)[1].tunnel, bob, "alice", file);
  cluster->run(Duration::ms(300));
  cluster->cut(0);
  cluster->run(Duration::s(2));
  ASSERT_FALSE(has(bob, file)) << "it was cut in the middle";
  cluster->join(0);
  EXPECT_TRUE(run_until([&] { return has(bob, file); }, Duration::s(40)));
}

// A chunk is bounded in one place, wherever it comes from.
TEST_F(ClusterFiles, WhatWasNotAskedForIsNotTaken) {
  open(2);
  (*cluster)[1].add("bob");
  const TestFile file = test_file(5000);
  choose_at(0, *alice, "alice", file);
  cluster->run(Duration::s(1));
  cluster::FileMessage message;
  message.server = (*cluster)[0].node->id();
  message.room = guest("salsa");
  message.guest = guest("alice");
  message.part = wire::FileChunk{{{}, file.hash}, file.size(), 0, file.chunk(0)};
  std::vector<std::uint8_t> bytes(cluster::kMaxBytes);
  bytes.resize(cluster::build(message, bytes));
  ASSERT_FALSE(bytes.empty());
  (*cluster)[1].arrivals.push_back({cluster->now(), false, "dance.1.to.0", bytes});
  const auto before = (*cluster)[1].tunnel.server().counters().of(ServerReject::kFileNotAsked);
  cluster->run(Duration::ms(5));
  EXPECT_EQ((*cluster)[1].tunnel.server().counters().of(ServerReject::kFileNotAsked), before + 1);
  EXPECT_EQ((*cluster)[1].tunnel.server().files().count(), 0u);
}

}  // namespace
}  // namespace dance
