// What peers may try with files at a server and a link, and what it costs: a count.
#include <gtest/gtest.h>

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

TEST_F(HostileFiles, ManyHashesOfOneGuestKeepOneGuestsPlace) {
  open();
  for (int i = 0; i < 500; ++i) {
    FileHash hash = test_file(1).hash;
    hash.bytes[1] = static_cast<std::uint8_t>(i);
    hash.bytes[2] = static_cast<std::uint8_t>(i >> 8);
    inject(*a, wire::FileWant{{slot_of("bob"), hash}, 0, 0xffffffff});
  }
  EXPECT_LE(tunnel->server().files().count(), 2u);
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
