// Poses beside a file: none lost, none behind more than one chunk, none later than without.
#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/tunnel/files/test_file.h"

namespace dance {
namespace {

struct Evening {
  SimulatedTunnel tunnel;
  SimulatedTunnel::House* a = nullptr;
  SimulatedTunnel::House* b = nullptr;
  Evening() {
    a = &tunnel.add_house("salsa", {"alice"});
    b = &tunnel.add_house("salsa", {"bob"});
    tunnel.run(Duration::ms(500));
  }
  // alice and bob dance, for so long.
  void dance(Duration duration) {
    Dance{tunnel, {{a, guest("alice")}, {b, guest("bob")}}}.run(duration);
  }
};

TEST(FilesAndPoses, NoPoseIsLostOrLaterThanWithoutAFile) {
  std::vector<std::vector<std::int64_t>> ages_us;
  for (const bool with_file : {false, true}) {
    Evening evening;
    evening.dance(Duration::s(2));
    const TestFile file = test_file(400'000);
    if (with_file) {
      choose(evening.tunnel, *evening.a, "alice", file);
      fetch(evening.tunnel, *evening.b, "alice", file);
    }
    const std::size_t before = evening.b->poses.size();
    evening.dance(Duration::s(6));
    std::vector<std::int64_t>& ages = ages_us.emplace_back();
    for (std::size_t i = before; i < evening.b->poses.size(); ++i) {
      const auto& heard = evening.b->poses[i];
      ages.push_back((heard.at - heard.pose.capture_time).count_us());
    }
    if (with_file) {
      EXPECT_EQ(evening.b->files[guest("alice")], file.bytes);
    }
    const auto stats = evening.b->link->remote_stats();
    ASSERT_EQ(stats.size(), 1u);
    EXPECT_EQ(stats[0].lost, 0u);
  }
  // Time passes in steps here, so that what waits for nothing takes the same.
  EXPECT_EQ(ages_us[0], ages_us[1]);
}

// The order in which datagrams leave an end is the order in which the network queues them: before a
// pose there is never more than one chunk that the pose might have to wait for.
TEST(FilesAndPoses, OfTheBytesThatLeaveAnEndChunksKeepToTheirRate) {
  Evening evening;
  struct Sent {
    MonoTime at;
    bool is_chunk;
  };
  std::map<PeerId, std::vector<Sent>> up, down;
  evening.tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    const auto type = wire::parse_opening(bytes)->type;
    if (type == wire::Type::kFileChunk || type == wire::Type::kRecords)
      (to_server ? up : down)[peer].push_back(
          {evening.tunnel.now(), type == wire::Type::kFileChunk});
    return true;
  };
  const TestFile file = test_file(400'000);
  choose(evening.tunnel, *evening.a, "alice", file);
  fetch(evening.tunnel, *evening.b, "alice", file);
  evening.dance(Duration::s(6));
  ASSERT_EQ(evening.b->files[guest("alice")], file.bytes);
  const double rate = evening.tunnel.link_options.file_bytes_per_second;
  for (const auto& sent : {up[evening.a->peer], down[evening.b->peer]}) {
    std::vector<MonoTime> chunks;
    for (const Sent& it : sent) {
      if (!it.is_chunk) continue;
      EXPECT_TRUE(chunks.empty() || it.at > chunks.back()) << "two chunks in one turn";
      chunks.push_back(it.at);
    }
    EXPECT_GE(chunks.size(), wire::chunks_of(file.size()));
    // In any stretch of time: the rate, and the one that may go at once.
    for (std::size_t i = 0; i < chunks.size(); ++i)
      for (const std::size_t n : {1u, 10u, 100u}) {
        if (i + n >= chunks.size()) continue;
        const double seconds = (chunks[i + n] - chunks[i]).as_seconds();
        EXPECT_LE(static_cast<double>(n - 1) * wire::kFileChunkCost, 1.1 * rate * seconds + 1200.0);
      }
  }
}

TEST(FilesAndPoses, AChunkWaitsWhileRecordsDo) {
  Evening evening;
  evening.tunnel.link_options.share_window = Duration::ms(4);
  auto& c = evening.tunnel.add_house("salsa", {"carol", "carl"});
  evening.tunnel.run(Duration::ms(500));
  const TestFile file = test_file(400'000);
  choose(evening.tunnel, c, "carol", file);
  fetch(evening.tunnel, *evening.b, "carol", file);
  // Records of one guest wait for those of the other; meanwhile nothing else goes.
  std::size_t waiting = 0, chunks = 0, overtaken = 0;
  evening.tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    if (!to_server || peer != c.peer) return true;
    const auto type = wire::parse_opening(bytes)->type;
    if (type == wire::Type::kRecords && (bytes[0] & 16) != 0) waiting = 0;
    if (type != wire::Type::kFileChunk) return true;
    ++chunks;
    if (waiting > 0) ++overtaken;
    return true;
  };
  evening.tunnel.run(Duration::s(3), [&] {
    const std::int64_t ms = evening.tunnel.now().since_zero_us() / 1000;
    if (ms % 16 != 0 && ms % 16 != 3) return;
    ++waiting;  // before it is sent: sending may empty the bundle at once
    evening.tunnel.dance(c, guest(ms % 16 == 0 ? "carol" : "carl"));
  });
  EXPECT_GT(chunks, 100u);
  EXPECT_EQ(overtaken, 0u);
}

TEST(FilesAndPoses, PosesAllocateNothingWhileAFileIsUnderWay) {
  Evening evening;
  const TestFile file = test_file(2'000'000);
  choose(evening.tunnel, *evening.a, "alice", file);
  fetch(evening.tunnel, *evening.b, "alice", file);
  evening.dance(Duration::s(2));
  EXPECT_FALSE(evening.b->files.contains(guest("alice")));
  const MonoTime now = evening.tunnel.time_in(*evening.a);
  const Pose pose = pose_number(evening.a->next_sequence++, now, evening.a->clock_id);
  evening.tunnel.on_datagram = [](bool, PeerId, wire::Bytes) { return false; };
  const AllocationGuard guard;
  evening.a->link->send(guest("alice"), pose, now);
  evening.a->link->tick(now);
  evening.a->link->next_deadline();
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
