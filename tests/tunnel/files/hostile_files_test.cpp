// What peers may try with files at a server and a link, and what it costs: a count.
#include <gtest/gtest.h>

#include <set>

#include "tests/tunnel/files/test_file.h"

namespace dance {
namespace {

class HostileFiles : public ::testing::Test {
 protected:
  void open(const ServerLimits& limits = {}) {
    tunnel = std::make_unique<SimulatedTunnel>(limits);
    tunnel->link_options.file_bytes_per_second = 400'000.0;
    a = &tunnel->add_house("salsa", {"alice"});
    b = &tunnel->add_house("salsa", {"bob"});
    tunnel->run(Duration::ms(500));
  }
  std::uint64_t rejected(ServerReject cause) const { return tunnel->server().counters().of(cause); }
  template <class Message>
  void inject(const SimulatedTunnel::House& house, const Message& message) {
    std::array<std::uint8_t, wire::kMaxPlain> out;
    tunnel->inject(house.peer, {out.data(), wire::build(message, out)});
  }
  wire::Slot slot_of(const char* name) const {
    const auto& room = tunnel->server().rooms()[tunnel->server().sessions()[0].room];
    for (std::uint8_t i = 0; i < room.guests.size(); ++i)
      if (room.guests[i].in_use && room.guests[i].id == guest(name))
        return {i, room.guests[i].generation};
    return {};
  }

  std::unique_ptr<SimulatedTunnel> tunnel;
  SimulatedTunnel::House* a = nullptr;
  SimulatedTunnel::House* b = nullptr;
};

TEST_F(HostileFiles, ChunksThatNobodyAskedForTakeNoMemory) {
  open();
  const TestFile file = test_file(50'000);
  for (std::uint16_t i = 0; i < 48; ++i)
    inject(*a, wire::FileChunk{{slot_of("alice"), file.hash}, file.size(), i, file.chunk(i)});
  EXPECT_EQ(rejected(ServerReject::kFileNotAsked), 48u);
  EXPECT_EQ(tunnel->server().files().size_bytes(), 0u);
  inject(*a, wire::FileChunk{{slot_of("bob"), file.hash}, file.size(), 0, file.chunk(0)});
  EXPECT_EQ(rejected(ServerReject::kForeignSlot), 1u) << "another's guest";
}

TEST_F(HostileFiles, WantsOfNobodysFileAreCounted) {
  open();
  const TestFile file = test_file(50'000);
  inject(*a, wire::FileWant{{{63, 1}, file.hash}, 0, 1});
  inject(*a, wire::FileWant{{slot_of("alice"), file.hash}, 0, 1});  // her own
  wire::Slot stale = slot_of("bob");
  ++stale.generation;
  inject(*a, wire::FileWant{{stale, file.hash}, 0, 1});
  EXPECT_EQ(rejected(ServerReject::kForeignSlot), 3u);
  EXPECT_EQ(tunnel->server().files().count(), 0u);
}

// Of two files that are under way in one room, a number of the larger one is none of the smaller.
TEST_F(HostileFiles, ANumberBeyondTheEndOfAnotherFileIsNotLookedUpInIt) {
  open();
  const TestFile small = test_file(2'000, 3), large = test_file(10'000'000, 5);
  choose(*tunnel, *a, "alice", small);
  choose(*tunnel, *b, "bob", large);
  tunnel->run(Duration::ms(200));
  std::set<std::size_t> asked_of_alice, asked_of_bob;
  tunnel->on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    if (opening->type == wire::Type::kFileChunk) return false;  // both stay incomplete
    if (to_server || opening->type != wire::Type::kFileWant) return true;
    const auto want = wire::parse_file_want(opening->body);
    for (std::size_t i = 0; i < wire::kMaxFileChunks; ++i)
      if (want->has(i)) (peer == a->peer ? asked_of_alice : asked_of_bob).insert(i);
    return true;
  };
  inject(*b, wire::FileWant{{slot_of("alice"), small.hash}, 0, 0xffffffff});
  inject(*a, wire::FileWant{{slot_of("bob"), large.hash}, 9'000, 0x80000001});
  inject(*a, wire::FileWant{{slot_of("bob"), large.hash}, 16'000, 1});
  tunnel->run(Duration::s(1));
  EXPECT_EQ(tunnel->server().files().count(), 2u);
  EXPECT_EQ(asked_of_alice, (std::set<std::size_t>{0, 1}));
  EXPECT_EQ(asked_of_bob, (std::set<std::size_t>{9'000, 9'031}));
}

TEST_F(HostileFiles, HashesThatNobodyHasChosenNeitherTakeAPlaceNorStopATransfer) {
  open();
  auto& c = tunnel->add_house("salsa", {"carol"});
  const TestFile file = test_file(200'000);
  choose(*tunnel, *a, "alice", file);
  tunnel->run(Duration::ms(500));
  fetch(*tunnel, *b, "alice", file);
  std::size_t up = 0, wants = 0;
  tunnel->on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    const auto type = wire::parse_opening(bytes)->type;
    if (to_server && peer == a->peer && type == wire::Type::kFileChunk) ++up;
    if (!to_server && peer == b->peer && type == wire::Type::kFileWant) ++wants;
    return true;
  };
  for (int i = 0; i < 500; ++i) {
    FileHash hash = test_file(1).hash;
    hash.bytes[1] = static_cast<std::uint8_t>(i);
    hash.bytes[2] = static_cast<std::uint8_t>(i >> 8);
    inject(c, wire::FileWant{{slot_of(i % 2 == 0 ? "alice" : "bob"), hash}, 0, 0xffffffff});
    tunnel->run(Duration::ms(5));
    EXPECT_LE(tunnel->server().files().count(), 1u);
  }
  EXPECT_EQ(b->files[guest("alice")], file.bytes);
  EXPECT_EQ(up, wire::chunks_of(file.size())) << "each chunk was sent up once";
  EXPECT_EQ(wants, 0u) << "bob's house was not asked for what he has not chosen";
  EXPECT_GE(tunnel->server().counters().file_refusals, 500u);
}

TEST_F(HostileFiles, AGuestThatChangesItsMindKeepsOneGuestsPlace) {
  open();
  for (std::uint8_t i = 0; i < 10; ++i) {
    const TestFile file = test_file(20'000, static_cast<std::uint8_t>(2 * i + 1));
    choose(*tunnel, *a, "alice", file);
    tunnel->run(Duration::ms(200));
    fetch(*tunnel, *b, "alice", file);
    tunnel->run(Duration::ms(800));
    EXPECT_EQ(b->files[guest("alice")], file.bytes) << static_cast<int>(i);
    EXPECT_LE(tunnel->server().files().count(), 2u);
  }
}

TEST_F(HostileFiles, AFileOfAnotherSizeThanSaidIsRefused) {
  open();
  const TestFile file = test_file(50'000);
  AvatarFile said = file.state();
  said.size_bytes = 60'000;
  a->link->files().offer(guest("alice"), file.hash, file.shared());
  a->link->send(guest("alice"), said, tunnel->time_in(*a));
  tunnel->run(Duration::ms(200));
  b->link->files().fetch(guest("alice"), file.hash, ChunkedFile(60'000), tunnel->time_in(*b));
  tunnel->run(Duration::s(1));
  ASSERT_FALSE(b->file_refusals.empty());
  EXPECT_EQ(b->file_refusals[0].second, wire::FileRefusalCause::kNotOffered);
  EXPECT_GT(rejected(ServerReject::kFileNotAsked), 0u);
  EXPECT_EQ(tunnel->server().counters().file_chunks_in, 0u);
}

TEST_F(HostileFiles, AnOwnersIdleFilesMakeRoomForItsNext) {
  ServerLimits limits;
  limits.file_bytes_per_session = 100'000;
  open(limits);
  auto& trio = tunnel->add_house("salsa", {"dora", "ella", "finn"});
  tunnel->run(Duration::ms(500));
  const std::array<const char*, 3> names{"dora", "ella", "finn"};
  for (std::uint8_t i = 0; i < 3; ++i) {
    const TestFile file = test_file(45'000, static_cast<std::uint8_t>(2 * i + 1));
    choose(*tunnel, trio, names[i], file);
    tunnel->run(Duration::ms(200));
    fetch(*tunnel, *b, names[i], file);
    tunnel->run(Duration::s(1));
    EXPECT_EQ(b->files.contains(guest(names[i])), i < 2) << "the first two are in use";
  }
  tunnel->run(Duration::s(25));
  EXPECT_EQ(b->files[guest("finn")], test_file(45'000, 5).bytes);
  EXPECT_LE(tunnel->server().files().size_bytes(), limits.file_bytes_per_session);
}

TEST_F(HostileFiles, ASessionGetsAFileTwiceAndNotForEver) {
  open();
  const TestFile file = test_file(20 * wire::kFileChunk);
  choose(*tunnel, *a, "alice", file);
  tunnel->run(Duration::ms(200));
  std::size_t down = 0;
  tunnel->on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    if (!to_server && peer == b->peer && wire::parse_opening(bytes)->type == wire::Type::kFileChunk)
      ++down;
    return true;
  };
  for (int i = 0; i < 100; ++i) {
    inject(*b, wire::FileWant{{slot_of("alice"), file.hash}, 0, 0xfffff});
    tunnel->run(Duration::ms(100));
  }
  EXPECT_EQ(down, 40u);
  // Others are not held back by it.
  auto& c = tunnel->add_house("salsa", {"carol"});
  tunnel->run(Duration::ms(500));
  fetch(*tunnel, c, "alice", file);
  tunnel->run(Duration::s(2));
  EXPECT_EQ(c.files[guest("alice")], file.bytes);
}

TEST_F(HostileFiles, TheRateOfAllTogetherIsUsedToItsEnd) {
  ServerLimits limits;
  limits.file_bytes_per_second = 20'000.0;
  limits.file_bytes_per_second_of_session = 12'000.0;
  open(limits);
  auto& c = tunnel->add_house("salsa", {"carol"});
  const TestFile file = test_file(600'000);
  choose(*tunnel, *a, "alice", file);
  tunnel->run(Duration::ms(500));
  fetch(*tunnel, *b, "alice", file);
  fetch(*tunnel, c, "alice", file);
  tunnel->run(Duration::s(5));
  const auto before = tunnel->server().counters().file_chunks_out;
  tunnel->run(Duration::s(20));
  const double bytes = static_cast<double>(tunnel->server().counters().file_chunks_out - before) *
                       wire::kFileChunkCost;
  EXPECT_GT(bytes, 0.95 * 20.0 * limits.file_bytes_per_second);
  EXPECT_LE(bytes, 1.05 * 20.0 * limits.file_bytes_per_second);
}

TEST_F(HostileFiles, MoreThanTheServerHoldsIsRefused) {
  ServerLimits limits;
  limits.file_bytes_per_session = 100'000;
  open(limits);
  const TestFile file = test_file(150'000);
  choose(*tunnel, *a, "alice", file);
  fetch(*tunnel, *b, "alice", file);
  tunnel->run(Duration::s(2));
  ASSERT_FALSE(b->file_refusals.empty());
  EXPECT_EQ(b->file_refusals[0].second, wire::FileRefusalCause::kFull);
  EXPECT_EQ(tunnel->server().files().size_bytes(), 0u);
  EXPECT_TRUE(b->files.empty());
}

TEST_F(HostileFiles, TheCacheIsBoundedInAll) {
  ServerLimits limits;
  limits.file_bytes = 120'000;
  open(limits);
  const TestFile first = test_file(80'000, 3), second = test_file(90'000, 5);
  choose(*tunnel, *a, "alice", first);
  choose(*tunnel, *b, "bob", second);
  fetch(*tunnel, *b, "alice", first);
  tunnel->run(Duration::s(2));
  EXPECT_EQ(b->files[guest("alice")], first.bytes);
  fetch(*tunnel, *a, "bob", second);
  tunnel->run(Duration::s(2));
  EXPECT_TRUE(a->files.empty()) << "the first is in use";
  tunnel->run(Duration::s(40));  // unused for ten seconds, it makes room
  EXPECT_EQ(a->files[guest("bob")], second.bytes);
  EXPECT_LE(tunnel->server().files().size_bytes(), limits.file_bytes);
}

TEST_F(HostileFiles, AWrongFileIsDroppedAndNotAskedForAgain) {
  open();
  b->files_are_right = false;
  const TestFile file = test_file(50'000);
  choose(*tunnel, *a, "alice", file);
  fetch(*tunnel, *b, "alice", file);
  tunnel->run(Duration::s(2));
  EXPECT_EQ(b->link->files().received().files_wrong, 1u);
  const auto asked = b->link->files().received().chunks_asked;
  fetch(*tunnel, *b, "alice", file);
  tunnel->run(Duration::s(2));
  EXPECT_EQ(b->link->files().received().chunks_asked, asked);
}

TEST_F(HostileFiles, ALinkRejectsWhatItHasNotAskedFor) {
  open();
  const TestFile file = test_file(50'000);
  const auto before = b->link->counters().rejected_datagrams;
  std::array<std::uint8_t, wire::kMaxPlain> out;
  const auto give = [&](const auto& message) {
    const MonoTime now = tunnel->time_in(*b);
    b->link->receive({out.data(), wire::build(message, out)}, now, now);
  };
  give(wire::FileChunk{{slot_of("alice"), file.hash}, file.size(), 0, file.chunk(0)});
  give(wire::FileWant{{slot_of("alice"), file.hash}, 0, 1});  // not its guest
  give(wire::FileRefusal{{slot_of("alice"), file.hash}, wire::FileRefusalCause::kFull});
  EXPECT_EQ(b->link->counters().rejected_datagrams, before + 3);
  EXPECT_TRUE(b->file_refusals.empty());
}

}  // namespace
}  // namespace dance
