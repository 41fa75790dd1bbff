// A file from house to house with real sockets, DTLS, disks and threads, while both dance; a server
// that is killed midway, and a house that begins anew.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/net/mono_clock.h"
#include "core/store/sha256.h"
#include "tests/test_folder.h"
#include "tests/tunnel/files/test_file.h"
#include "tests/tunnel/seal/guest_key.h"
#include "tunnel/link/link_avatars.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

class FileFlow : public ::testing::Test {
 protected:
  struct House {
    explicit House(const std::string& name)
        : who(guest(name)), folder(name), store(folder.path("data"), folder.path("cache")) {}
    GuestId who;
    TestFolder folder;
    AvatarStore store;
    std::vector<std::uint32_t> heard;  // numbers of poses, as they came
    std::vector<std::string> told;
    std::uint32_t next = 1;
    std::unique_ptr<LinkAvatars> avatars;
    std::unique_ptr<Link> link;
  };

  void SetUp() override {
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller = std::move(*made);
    KeyRing ring;
    ASSERT_TRUE(ring.add(key));
    options.keys = std::make_shared<const KeyRing>(std::move(ring));
    start_server(Address::loopback(0));
    address = server->local_address();
  }
  void start_server(const Address& at) {
    auto opened = Server::open(at, options, *poller);
    ASSERT_TRUE(opened) << opened.error().what;
    server = std::move(*opened);
  }
  void open(House& house) {
    house.avatars =
        std::make_unique<LinkAvatars>(house.store, *WakeEvent::create(), *poller,
                                      [&](const std::string& line) { house.told.push_back(line); });
    LinkHandlers handlers;
    handlers.on_pose = [&](const GuestId&, const Pose& pose, MonoTime) {
      house.heard.push_back(pose.sequence);
    };
    handlers.on_avatar_file = [&](const GuestId& who, const AvatarFile& file, MonoTime) {
      house.avatars->hear(who, file);
    };
    house.avatars->add_to(handlers);
    LinkOptions of;
    of.room = guest("salsa");
    of.file_bytes_per_second = rate;
    ASSERT_TRUE(of.guests.try_push(house.who));
    auto opened = Link::open({address}, link_key_of(key, options.identity.public_key()), of,
                             std::move(handlers), *poller);
    ASSERT_TRUE(opened);
    house.link = std::move(*opened);
    house.avatars->attach(*house.link);
    ASSERT_TRUE(turn_until([&] { return house.link->is_connected(); }));
  }
  // As a producer does, a frame later each time; both houses.
  void dance_once() {
    for (House* house : {&alice, &bob}) {
      if (!house->link) continue;
      const MonoTime now = mono_now();
      house->link->send(house->who, pose_number(house->next++, now, this_clock_id()), now);
    }
  }
  // Turns until it is so; the time only ends a test that has failed.
  bool turn_until(const std::function<bool()>& is_so, bool dancing = false) {
    const MonoTime given_up = mono_now() + Duration::s(60);
    MonoTime next_pose = mono_now();
    bool so = is_so();
    for (; !so && mono_now() < given_up; so = is_so()) {
      poller->run_once(Duration::ms(4));
      if (!dancing || mono_now() < next_pose) continue;
      next_pose += Duration::ms(16);
      dance_once();
    }
    return so;
  }
  AvatarFile keep(House& house, const TestFile& file) {
    AvatarStore::Kept kept{sha256_of(file.bytes), file.bytes};
    EXPECT_TRUE(house.store.keep_own(kept, true));
    AvatarFile said = file.state();
    said.hash = kept.hash;
    EXPECT_TRUE(said.name.assign("me.vrm"));
    return said;
  }
  static bool has(const House& house, const AvatarFile& file) {
    return !house.store.find(file.hash).empty();
  }

  double rate = 300'000.0;
  GuestKey key = key_of("any", KeyKind::kRoom);
  ServerOptions options;
  std::unique_ptr<Poller> poller;
  std::unique_ptr<Server> server;
  Address address;
  House alice{"alice"}, bob{"bob"};
};

TEST_F(FileFlow, AFileArrivesByteForByteWhileNoPoseIsLost) {
  open(alice);
  open(bob);
  // The first poses need the others' presence.
  ASSERT_TRUE(turn_until([&] { return bob.heard.size() > 20 && alice.heard.size() > 20; }, true));
  const TestFile file = test_file(400'000);
  const AvatarFile said = keep(alice, file);
  const std::uint32_t first = bob.heard.back();
  alice.avatars->choose(alice.who, said, mono_now());
  ASSERT_TRUE(turn_until([&] { return has(bob, said); }, true));
  EXPECT_EQ(bob.store.read(said.hash), file.bytes);
  EXPECT_TRUE(bob.store.find(said.hash).ends_with(".vrm"));
  // All that alice danced meanwhile came, each once and in order.
  ASSERT_TRUE(turn_until([&] { return bob.heard.back() + 1 == alice.next; }, false));
  std::uint32_t expected = 0;
  for (const std::uint32_t number : bob.heard) {
    if (number < first) continue;
    if (expected != 0) {
      EXPECT_EQ(number, expected);
    }
    expected = number + 1;
  }
  EXPECT_GT(alice.next, first + 60) << "it took a while";
  EXPECT_EQ(bob.link->remote_stats().at(0).lost, 0u);
  EXPECT_EQ(server->core().counters().of(ServerReject::kFileNotAsked), 0u);
  ASSERT_TRUE(turn_until([&] { return !bob.told.empty(); }));
  EXPECT_EQ(bob.told.back(), "alice's avatar has arrived");
}

TEST_F(FileFlow, AServerThatIsKilledMidwayCostsOnlyTime) {
  open(alice);
  open(bob);
  const TestFile file = test_file(500'000);
  const AvatarFile said = keep(alice, file);
  alice.avatars->choose(alice.who, said, mono_now());
  const auto& received = bob.link->core().files().received();
  ASSERT_TRUE(turn_until([&] { return received.chunks_taken > 100; }, true));
  ASSERT_FALSE(has(bob, said));
  server.reset();  // its links hear goodbye as little as from a process that is killed
  ASSERT_TRUE(turn_until([&] { return !bob.link->is_connected(); }, true));
  start_server(address);
  ASSERT_TRUE(turn_until([&] { return has(bob, said); }, true));
  EXPECT_EQ(bob.store.read(said.hash), file.bytes);
  EXPECT_EQ(received.chunks_taken, wire::chunks_of(file.size())) << "nothing came twice";
}

TEST_F(FileFlow, AHouseThatBeginsAnewGoesOnWhereItWas) {
  open(alice);
  open(bob);
  const TestFile file = test_file(500'000);
  const AvatarFile said = keep(alice, file);
  alice.avatars->choose(alice.who, said, mono_now());
  ASSERT_TRUE(turn_until(
      [&] { return bob.store.part(alice.who, said.hash).size() >= 2 * ChunkedFile::kBlock; },
      true));
  const std::size_t kept = bob.store.part(alice.who, said.hash).size() / ChunkedFile::kBlock;
  bob.link.reset();
  bob.avatars.reset();
  open(bob);
  ASSERT_TRUE(turn_until([&] { return has(bob, said); }, true));
  EXPECT_EQ(bob.store.read(said.hash), file.bytes);
  EXPECT_LE(bob.link->core().files().received().chunks_taken,
            wire::chunks_of(file.size()) - kept * ChunkedFile::kChunksPerBlock);
  EXPECT_TRUE(bob.store.part(alice.who, said.hash).empty());
}

TEST_F(FileFlow, AFileOfAnotherHashIsNotKept) {
  open(alice);
  open(bob);
  const TestFile file = test_file(100'000);
  AvatarFile said = file.state();  // a hash that its bytes do not have
  alice.link->core().files().offer(alice.who, said.hash, file.shared());
  alice.link->send(alice.who, said, mono_now());
  ASSERT_TRUE(
      turn_until([&] { return bob.link->core().files().received().files_wrong == 1; }, true));
  EXPECT_FALSE(has(bob, said));
  EXPECT_TRUE(bob.store.list().empty());
  EXPECT_EQ(bob.told, std::vector<std::string>{"alice's avatar came damaged; it is not shown"});
}

// As another who called himself alice in another room may have left them here.
TEST_F(FileFlow, WrongBytesThatWereKeptOfBeforeCostOneMoreTransfer) {
  open(alice);
  open(bob);
  const TestFile file = test_file(200'000);
  const AvatarFile said = keep(alice, file);
  const std::vector<std::uint8_t> garbage(ChunkedFile::kBlock, 7);
  ASSERT_TRUE(bob.store.add_part(alice.who, said.hash, 0, garbage));
  alice.avatars->choose(alice.who, said, mono_now());
  ASSERT_TRUE(turn_until([&] { return has(bob, said); }, true));
  EXPECT_EQ(bob.store.read(said.hash), file.bytes);
  ASSERT_TRUE(turn_until([&] { return bob.told.size() == 3; }));
  EXPECT_NE(bob.told[1].find("fetched from the begin"), std::string::npos) << bob.told[1];
  EXPECT_EQ(bob.told[2], "alice's avatar has arrived");
  EXPECT_EQ(bob.link->core().files().received().files_wrong, 0u);
}

TEST_F(FileFlow, WhatTheDiskDoesNotTakeIsNotCalledWrong) {
  std::ofstream(bob.store.foreign_folder()).put('x');  // no folder
  open(alice);
  open(bob);
  const TestFile file = test_file(100'000);
  const AvatarFile said = keep(alice, file);
  alice.avatars->choose(alice.who, said, mono_now());
  ASSERT_TRUE(turn_until([&] { return !bob.told.empty(); }, true));
  EXPECT_NE(bob.told[0].find("cannot be kept"), std::string::npos) << bob.told[0];
  EXPECT_EQ(bob.link->core().files().received().files_wrong, 0u);
  std::filesystem::remove(bob.store.foreign_folder());
  bob.avatars->hear(alice.who, said);
  ASSERT_TRUE(turn_until([&] { return has(bob, said); }, true));
}

TEST_F(FileFlow, AGuestThatChoosesWithoutEndCostsALookASecond) {
  open(bob);
  const MonoTime begin = mono_now();
  AvatarFile said;
  for (int i = 0; i < 500; ++i) {
    said = test_file(100'000, static_cast<std::uint8_t>(i)).state();
    said.hash.bytes[1] = static_cast<std::uint8_t>(i >> 8);
    bob.avatars->hear(alice.who, said);
  }
  bob.avatars->wait();
  EXPECT_GE(bob.avatars->looks(), 1u);
  EXPECT_LE(static_cast<double>(bob.avatars->looks()), 1.0 + (mono_now() - begin).as_seconds());
  EXPECT_TRUE(bob.link->core().files().fetches(alice.who, said.hash)) << "the newest";
}

TEST_F(FileFlow, AHouseWithoutFilesIsToldOnce) {
  open(bob);
  LinkHandlers handlers;
  bob.avatars->add_to(handlers);
  for (std::uint8_t i = 1; i < 4; ++i)
    handlers.on_file_refused(alice.who, test_file(1, i).hash, wire::FileRefusalCause::kNoFiles);
  EXPECT_EQ(bob.told.size(), 1u);
}

TEST_F(FileFlow, AnOwnFileThatIsNotKeptHereIsToldOnceWithTheCure) {
  open(alice);
  const AvatarFile said = test_file(100'000).state();
  for (int i = 0; i < 3; ++i) {
    alice.avatars->choose(alice.who, said, mono_now());
    alice.avatars->wait();
  }
  ASSERT_EQ(alice.told.size(), 1u);
  EXPECT_NE(alice.told[0].find("dance avatar choose alice FILE"), std::string::npos);
}

}  // namespace
}  // namespace dance
