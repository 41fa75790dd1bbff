// Keys that a cluster shares: what is taken of the bucket, and whose counts where the file has one
// too.
#include "tunnel/server/program/cluster/cluster_keys.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/test_folder.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/server/program/key_command.h"
#include "tunnel/server/program/server_keys.h"

namespace dance {
namespace {

KeyEntry key_entry(const std::string& name, KeyKind kind = KeyKind::kGuest) {
  KeyEntry entry;
  entry.name = *GuestId::parse(name);
  entry.kind = kind;
  entry.key = PrivateKey::make().public_key();
  return entry;
}

TEST(ClusterKeys, AreThoseOfTheBucketUntilTheyAreTakenAway) {
  ClusterKeys keys;
  const KeyEntry alice = key_entry("alice"), bob = key_entry("bob", KeyKind::kHost);
  EXPECT_FALSE(keys.take_changed());
  keys.take("alice", line_of(alice));
  keys.take("bob", line_of(bob));
  EXPECT_TRUE(keys.take_changed());
  ASSERT_EQ(keys.entries().size(), 2u);
  EXPECT_EQ(keys.entries().at(alice.name), alice);
  EXPECT_EQ(keys.entries().at(bob.name), bob);
  // After a break all come once more.
  keys.take("alice", line_of(alice));
  EXPECT_FALSE(keys.take_changed());
  keys.take("alice", std::nullopt);
  EXPECT_TRUE(keys.take_changed());
  EXPECT_FALSE(keys.entries().contains(alice.name));
  keys.take("nobody", std::nullopt);
  EXPECT_FALSE(keys.take_changed());
  EXPECT_FALSE(keys.take_wrong());
}

TEST(ClusterKeys, AWrongEntryOpensNothingAndIsOneWarning) {
  const KeyEntry alice = key_entry("alice");
  const std::string line = line_of(alice);
  for (const std::string& wrong :
       {std::string(), std::string("#"), line + "\n" + line_of(key_entry("bob")),
        line_of(key_entry("bob")), line + "A", line.substr(0, line.size() - 1),
        std::string("alice guest * \033[2J"), "alice guest \033[2J " + alice.key.text(),
        std::string(5000, 'a'), std::string("alice guest *\0", 14), "x " + line}) {
    ClusterKeys keys;
    keys.take("alice", line);
    EXPECT_TRUE(keys.take_changed());
    keys.take("alice", wrong);
    EXPECT_TRUE(keys.take_changed()) << wrong;
    EXPECT_TRUE(keys.entries().empty()) << wrong;
    const auto said = keys.take_wrong();
    ASSERT_TRUE(said) << wrong;
    EXPECT_NE(said->find("alice"), std::string::npos) << *said;
    EXPECT_EQ(said->find(alice.key.text().substr(0, 20)), std::string::npos) << "a key is no text";
    EXPECT_EQ(said->find('\033'), std::string::npos);
    EXPECT_EQ(said->find('\n'), std::string::npos);
    EXPECT_FALSE(keys.take_wrong()) << "said once";
  }
}

TEST(ClusterKeys, DetectAServerWithAnotherIdentityThanTheClusters) {
  const PublicKey own = PrivateKey::make().public_key();
  ClusterKeys keys;
  EXPECT_FALSE(keys.other_identity(own)) << "no guest has a key yet";
  keys.take(kClusterIdentity, own.text());
  EXPECT_TRUE(keys.take_changed());
  EXPECT_FALSE(keys.other_identity(own));
  EXPECT_TRUE(keys.entries().empty());
  const auto other = keys.other_identity(PrivateKey::make().public_key());
  ASSERT_TRUE(other);
  EXPECT_NE(other->find("copy server-identity.key"), std::string::npos) << *other;
  keys.take(kClusterIdentity, "no key");
  EXPECT_TRUE(keys.take_wrong());
  EXPECT_TRUE(keys.take_changed());
  EXPECT_FALSE(keys.other_identity(own));
  keys.take(kClusterIdentity, std::nullopt);
  EXPECT_FALSE(keys.take_changed());
}

TEST(ClusterKeys, NamesThatNoneCanHaveOpenNothing) {
  ClusterKeys keys;
  const std::string line = line_of(key_entry("alice"));
  for (const char* name : {"", "Alice", "a.b", kLocalKeyName, "\033[2J"}) keys.take(name, line);
  EXPECT_TRUE(keys.entries().empty());
  EXPECT_FALSE(keys.take_changed());
  const auto said = keys.take_wrong();
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("and 4 more"), std::string::npos) << *said;
}

TEST(ClusterKeys, AreKeptAndNamedWhenTheirBucketWasLost) {
  ClusterKeys keys;
  for (const char* name : {"alice", "bob", "carol"}) keys.take(name, line_of(key_entry(name)));
  EXPECT_TRUE(keys.take_changed());
  EXPECT_FALSE(keys.take_lost()) << "nothing was lost";
  keys.expect_again();
  keys.take("bob", line_of(key_entry("bob")));
  keys.take("carol", std::nullopt);  // revoked meanwhile
  const auto lost = keys.take_lost();
  ASSERT_TRUE(lost);
  EXPECT_NE(lost->find("has lost the keys of alice: "), std::string::npos) << *lost;
  EXPECT_NE(lost->find("--new-guest"), std::string::npos) << *lost;
  EXPECT_EQ(keys.entries().size(), 2u) << "alice dances on";
  EXPECT_FALSE(keys.take_lost()) << "once";
  for (int i = 0; i < 40; ++i) {
    const std::string name = "guest-" + std::to_string(i);
    keys.take(name, line_of(key_entry(name)));
  }
  keys.expect_again();
  EXPECT_NE(keys.take_lost()->find(" and 22 more: "), std::string::npos);
}

TEST(ClusterKeys, AreNotMoreThanAServerTakes) {
  ClusterKeys keys;
  KeyEntry entry = key_entry("a");
  for (std::size_t i = 0; i <= KeyRing::kMost; ++i) {
    entry.name = *GuestId::parse("a" + std::to_string(i));
    keys.take(entry.name.view(), line_of(entry));
  }
  EXPECT_EQ(keys.entries().size(), KeyRing::kMost);
  EXPECT_TRUE(keys.take_wrong());
}

class UnitedKeys : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1); }
  std::string file() const { return folder_.path("server-keys"); }
  TestFolder folder_{"united_keys"};
};

TEST_F(UnitedKeys, AreThoseOfTheFileAndOfTheClusterWhoseCountsWhereANameIsInBoth) {
  KeyRing ring;
  const KeyEntry alice = key_entry("alice"), bob = key_entry("bob");
  ring.add(alice);
  ring.add(bob);
  ASSERT_TRUE(write_secret(file(), ring.text()));
  auto keys = ServerKeys::open(file());
  ASSERT_TRUE(keys) << keys.error().what;
  EXPECT_EQ(keys->guest_count(), 2u);
  const KeyEntry others_bob = key_entry("bob"), carol = key_entry("carol");
  keys->set_cluster({{others_bob.name, others_bob}, {carol.name, carol}});
  EXPECT_EQ(keys->guest_count(), 3u);
  EXPECT_EQ(*keys->ring()->find("alice"), alice);
  EXPECT_EQ(*keys->ring()->find("bob"), others_bob);
  EXPECT_EQ(*keys->ring()->find("carol"), carol);
  EXPECT_TRUE(keys->ring()->find(kLocalKeyName)->is_local());
  EXPECT_EQ(keys->in_both(), 1u);
  // The file changes, and the cluster's stay.
  ring.remove("alice");
  ASSERT_TRUE(write_secret(file(), ring.text()));
  const auto changed = keys->read_again();
  ASSERT_TRUE(changed && *changed);
  EXPECT_EQ(keys->ring()->find("alice"), nullptr);
  EXPECT_EQ(*keys->ring()->find("carol"), carol);
  keys->set_cluster({});
  EXPECT_EQ(*keys->ring()->find("bob"), bob) << "the file's counts again";
  EXPECT_EQ(keys->guest_count(), 1u);
}

TEST_F(UnitedKeys, ThisMachinesKeyIsNeverLeftOut) {
  auto keys = ServerKeys::open(file());
  ASSERT_TRUE(keys) << keys.error().what;
  std::map<GuestId, KeyEntry> many;
  KeyEntry entry = key_entry("a");
  for (std::size_t i = 0; i < KeyRing::kMost; ++i) {
    entry.name = *GuestId::parse("a" + std::to_string(i));
    many.emplace(entry.name, entry);
  }
  keys->set_cluster(many);
  EXPECT_NE(keys->ring()->find(kLocalKeyName), nullptr);
  EXPECT_EQ(keys->left_out(), 1u);
}

TEST_F(UnitedKeys, CommandsChangeTheFile) {
  const auto store = file_key_store(file());
  KeyCommand command;
  command.new_guest = "alice";
  ASSERT_TRUE(run_key_command(command, *store));
  EXPECT_FALSE(run_key_command(command, *store)) << "she has a key already";
  const auto ring = store->read();
  ASSERT_TRUE(ring);
  ASSERT_EQ(ring->entries().size(), 1u);
  KeyCommand remove;
  remove.remove = "alice";
  ASSERT_TRUE(run_key_command(remove, *store));
  EXPECT_FALSE(run_key_command(remove, *store)) << "there is none any more";
  EXPECT_TRUE(store->read()->entries().empty());
}

}  // namespace
}  // namespace dance
