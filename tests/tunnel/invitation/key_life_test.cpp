// The life of an invitation's key in a server's file: issued, used, revoked, expired, replaced.
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "tests/test_folder.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/seal/keys/utc_text.h"
#include "tunnel/server/program/cluster/cluster_keys.h"
#include "tunnel/server/program/invite_command.h"
#include "tunnel/server/program/key_command.h"
#include "tunnel/server/program/key_store.h"
#include "tunnel/server/program/server_keys.h"

namespace dance {
namespace {

constexpr std::int64_t kNow_s = 1'795'766'400;  // a whole minute

KeyEntry invited_entry(std::string_view name, std::int64_t until_s = kNow_s + 3600) {
  KeyEntry entry;
  entry.name = *GuestId::parse(name);
  entry.has_key = false;
  entry.invitation =
      InvitationKey{PrivateKey::make().public_key(), until_s, InvitationState::kOpen};
  return entry;
}

KeyEntry plain_entry(std::string_view name) {
  KeyEntry entry;
  entry.name = *GuestId::parse(name);
  entry.key = PrivateKey::make().public_key();
  return entry;
}

KeyRing written_and_read(const KeyRing& ring) {
  const auto back = KeyRing::parse(ring.text(), "keys");
  EXPECT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->entries(), ring.entries());
  return back.value_or(KeyRing());
}

TEST(InvitationKeys, TheFirstHouseGetsInAndNoOther) {
  KeyRing ring;
  ASSERT_TRUE(ring.invite(invited_entry("alice")));
  ring = written_and_read(ring);
  // It opens no room, and keeps the name for its guest.
  EXPECT_EQ(ring.find("alice"), nullptr);
  ASSERT_NE(ring.find_invitation("alice"), nullptr);
  EXPECT_TRUE(ring.is_own_name("alice-2"));
  const PublicKey first = PrivateKey::make().public_key(), second = PrivateKey::make().public_key();
  EXPECT_FALSE(ring.settled_binding("alice", first, kNow_s));
  EXPECT_EQ(ring.bind("alice", first, kNow_s), Binding::kBound);
  ring = written_and_read(ring);
  ASSERT_NE(ring.find("alice"), nullptr);
  EXPECT_TRUE(ring.find("alice")->key == first);
  // Again, as an answer may have been lost, also when its time is over: the same house.
  EXPECT_EQ(ring.bind("alice", first, kNow_s + 7200), Binding::kBound);
  EXPECT_EQ(ring.bind("alice", second, kNow_s), Binding::kUsed);
  EXPECT_TRUE(ring.find("alice")->key == first);
  EXPECT_EQ(ring.bind("bob", second, kNow_s), Binding::kUnknown);
}

TEST(InvitationKeys, TheKeyOpensWhatTheInvitationSaid) {
  KeyRing ring;
  KeyEntry host = invited_entry("bob");
  host.kind = KeyKind::kHost;
  host.room = *GuestId::parse("salsa");
  ASSERT_TRUE(ring.invite(host));
  ASSERT_EQ(ring.bind("bob", PrivateKey::make().public_key(), kNow_s), Binding::kBound);
  ring = written_and_read(ring);
  ASSERT_NE(ring.find("bob"), nullptr);
  EXPECT_EQ(ring.find("bob")->kind, KeyKind::kHost);
  EXPECT_EQ(ring.find("bob")->room, host.room);
}

TEST(InvitationKeys, NeitherExpiredNorRevokedOnesBind) {
  KeyRing ring;
  ASSERT_TRUE(ring.invite(invited_entry("alice")));
  ASSERT_TRUE(ring.invite(invited_entry("bob")));
  const PublicKey key = PrivateKey::make().public_key();
  EXPECT_EQ(ring.bind("alice", key, kNow_s + 3600), Binding::kExpired);
  EXPECT_EQ(ring.find("alice"), nullptr);
  EXPECT_TRUE(ring.remove("bob"));
  EXPECT_FALSE(ring.remove("bob"));
  ring = written_and_read(ring);
  EXPECT_EQ(ring.bind("bob", key, kNow_s), Binding::kRevoked);
  EXPECT_FALSE(ring.is_own_name("bob"));
  // The key that came of one is revoked with it.
  EXPECT_EQ(ring.bind("alice", key, kNow_s), Binding::kBound);
  EXPECT_TRUE(ring.remove("alice"));
  EXPECT_EQ(ring.find("alice"), nullptr);
  EXPECT_EQ(ring.bind("alice", key, kNow_s), Binding::kRevoked);
  EXPECT_EQ(ring.text().find(key.text()), std::string::npos);
}

TEST(InvitationKeys, AnInvitationsOwnKeyNeverBecomesTheGuests) {
  KeyRing ring;
  const KeyEntry alice = invited_entry("alice");
  ASSERT_TRUE(ring.invite(alice));
  EXPECT_NE(ring.bind("alice", alice.invitation->key, kNow_s), Binding::kBound);
  EXPECT_EQ(ring.find("alice"), nullptr);
}

TEST(InvitationKeys, ThereIsOneForEachGuest) {
  KeyRing ring;
  const KeyEntry first = invited_entry("alice"), second = invited_entry("alice");
  ASSERT_TRUE(ring.invite(first));
  ASSERT_TRUE(ring.invite(second));
  ASSERT_EQ(ring.entries().size(), 1u);
  EXPECT_TRUE(ring.find_invitation("alice")->invitation->key == second.invitation->key);
  EXPECT_FALSE(ring.add(plain_entry("alice")));
  // A guest who has a key keeps it.
  ASSERT_TRUE(ring.add(plain_entry("bob")));
  EXPECT_FALSE(ring.invite(invited_entry("bob")));
  EXPECT_EQ(ring.find_invitation("bob"), nullptr);
  // After a revocation there is room for either.
  ASSERT_TRUE(ring.remove("alice"));
  EXPECT_TRUE(ring.add(plain_entry("alice")));
  EXPECT_EQ(ring.find_invitation("alice"), nullptr);
}

TEST(InvitationKeys, AreForgottenADayAfterTheirTime) {
  KeyRing ring;
  for (const char* name : {"open", "used", "revoked"})
    ASSERT_TRUE(ring.invite(invited_entry(name)));
  const PublicKey key = PrivateKey::make().public_key();
  ASSERT_EQ(ring.bind("used", key, kNow_s), Binding::kBound);
  ASSERT_TRUE(ring.remove("revoked"));
  ring.forget_invitations(kNow_s + 3600 + 86'400);
  EXPECT_EQ(ring.entries().size(), 3u);
  ring.forget_invitations(kNow_s + 3600 + 86'401);
  ASSERT_EQ(ring.entries().size(), 1u);
  ASSERT_NE(ring.find("used"), nullptr);
  EXPECT_TRUE(ring.find("used")->key == key);
  EXPECT_EQ(ring.find_invitation("used"), nullptr);
}

TEST(InvitationKeys, ALineThatIsWrongIsSaidWithoutItsKeys) {
  const std::string key = PrivateKey::make().public_key().text();
  const auto says = [&](const std::string& text, const std::string& part) {
    const auto ring = KeyRing::parse(text, "keys");
    ASSERT_FALSE(ring) << text;
    EXPECT_NE(ring.error().what.find(part), std::string::npos) << ring.error().what;
    EXPECT_EQ(ring.error().what.find(key.substr(0, 20)), std::string::npos);
  };
  const std::string until = " 20261127T0800Z";
  says("alice guest * -", "- stands for the key of a guest who is invited");
  says("alice guest * " + key + " invited " + key + until, "- stands for");
  says("alice guest * - used " + key + until, "- stands for");
  says("alice guest * - lost " + key + until, "invited, used or revoked");
  says("alice guest * - invited " + key, "until");
  says("alice guest * - invited " + key + " tomorrow", "until");
  says("alice guest * - invited " + key + "x" + until, "its key");
  says("alice guest * - invited " + key + until + " x", "until");
  says("salsa room salsa - invited " + key + until, "for one guest");
}

TEST(InvitationKeys, ACountOfGuestsLeavesOutWhatWasRevoked) {
  const TestFolder folder("invited-count");
  setenv("XDG_CONFIG_HOME", folder.path("config").c_str(), 1);
  const auto store = file_key_store(folder.path("config/dance/server-keys"));
  const std::int64_t until_s = utc_now_s() / 60 * 60 + 3600;
  ASSERT_TRUE(*store->invite(invited_entry("alice", until_s)));
  ASSERT_TRUE(*store->invite(invited_entry("bob", until_s)));
  ASSERT_TRUE(*store->remove("bob"));
  const auto keys = ServerKeys::open("");
  ASSERT_TRUE(keys) << keys.error().what;
  EXPECT_EQ(keys->guest_count(), 1u);
}

TEST(InvitationKeys, AFileTellsEveryHouseTheSame) {
  const TestFolder folder("invited-file");
  const auto store = file_key_store(folder.path("server-keys"));
  const std::int64_t until_s = utc_now_s() / 60 * 60 + 3600;
  ASSERT_TRUE(*store->invite(invited_entry("alice", until_s)));
  // Eight houses at once, each over a store of its own: one gets in, and the file says which.
  constexpr std::size_t kHouses = 8;
  std::array<PublicKey, kHouses> made;
  std::array<Binding, kHouses> bound{};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < kHouses; ++i) {
    made[i] = PrivateKey::make().public_key();
    threads.emplace_back([&, i] {
      const auto own = file_key_store(folder.path("server-keys"));
      bound[i] = own->bind("alice", made[i]).value_or(Binding::kNotKept);
    });
  }
  // Beside them others are invited.
  for (int i = 0; i < 8; ++i)
    EXPECT_TRUE(*store->invite(invited_entry("guest-" + std::to_string(i), until_s)));
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::ranges::count(bound, Binding::kBound), 1);
  EXPECT_EQ(std::ranges::count(bound, Binding::kUsed), static_cast<std::ptrdiff_t>(kHouses) - 1);
  const auto ring = store->read();
  ASSERT_TRUE(ring) << ring.error().what;
  EXPECT_EQ(ring->entries().size(), 9u);
  ASSERT_NE(ring->find("alice"), nullptr);
  const auto winner =
      static_cast<std::size_t>(std::ranges::find(bound, Binding::kBound) - bound.begin());
  EXPECT_TRUE(ring->find("alice")->key == made[winner]);
  EXPECT_EQ(*store->bind("alice", made[winner]), Binding::kBound);
}

TEST(InvitationKeys, AClusterTakesNone) {
  ClusterKeys keys;
  keys.take("alice", line_of(invited_entry("alice")));
  EXPECT_TRUE(keys.entries().empty());
  const auto wrong = keys.take_wrong();
  ASSERT_TRUE(wrong);
  EXPECT_NE(wrong->find("an invitation, which a cluster does not take"), std::string::npos)
      << *wrong;
}

TEST(InviteCommand, TakesTimesThatPeopleWrite) {
  EXPECT_EQ(*parse_validity_s("--for", "1m", 90), 60);
  EXPECT_EQ(*parse_validity_s("--for", "90m", 90), 5400);
  EXPECT_EQ(*parse_validity_s("--for", "24h", 90), 86'400);
  EXPECT_EQ(*parse_validity_s("--for", "90d", 90), 90 * 86'400);
  for (const char* bad : {"", "h", "0h", "-1h", "24", "24 h", "1.5h", "91d", "2161h", "1w", "24hh",
                          "99999999999999999999h"}) {
    const auto parsed = parse_validity_s("--for", bad, 90);
    ASSERT_FALSE(parsed) << bad;
    EXPECT_NE(parsed.error().what.find("24h"), std::string::npos);
  }
}

class KeyCommands : public ::testing::Test {
 protected:
  std::string error_of(const KeyCommand& command) {
    ::testing::internal::CaptureStdout();
    const auto done = run_key_command(command, *store_);
    printed_ = ::testing::internal::GetCapturedStdout();
    return done ? "" : done.error().what;
  }
  TestFolder folder_{"key-commands"};
  std::unique_ptr<KeyStore> store_ = file_key_store(folder_.path("server-keys"));
  std::string printed_;
};

TEST_F(KeyCommands, MakeKeysThatExpireAndListUntilWhen) {
  KeyCommand command;
  command.new_guest = "alice";
  command.key_for = "30d";
  const std::int64_t before_s = utc_now_s();
  ASSERT_EQ(error_of(command), "");
  const auto ring = store_->read();
  ASSERT_TRUE(ring);
  ASSERT_NE(ring->find("alice"), nullptr);
  ASSERT_TRUE(ring->find("alice")->until_s);
  EXPECT_GE(*ring->find("alice")->until_s, before_s + 30 * 86'400 - 60);
  EXPECT_LE(*ring->find("alice")->until_s, utc_now_s() + 30 * 86'400);
  KeyCommand list;
  list.list = true;
  ASSERT_EQ(error_of(list), "");
  EXPECT_NE(printed_.find("key until 20"), std::string::npos) << printed_;
}

TEST_F(KeyCommands, InviteReplacesAnExpiredKey) {
  KeyEntry old = plain_entry("alice");
  old.until_s = utc_now_s() - 60;
  ASSERT_TRUE(*store_->add(old));
  KeyCommand list;
  list.list = true;
  ASSERT_EQ(error_of(list), "");
  EXPECT_NE(printed_.find("key expired 20"), std::string::npos) << printed_;
  KeyCommand invite;
  invite.invite = "alice";
  invite.address = "dance.example.org";
  invite.key_for = "90d";
  ASSERT_EQ(error_of(invite), "");
  const PublicKey house = PrivateKey::make().public_key();
  ASSERT_EQ(*store_->bind("alice", house), Binding::kBound);
  const auto ring = store_->read();
  ASSERT_TRUE(ring);
  ASSERT_NE(ring->find("alice"), nullptr);
  EXPECT_TRUE(ring->find("alice")->key == house);
  ASSERT_TRUE(ring->find("alice")->until_s) << "the key expires as the invitation said";
  EXPECT_GT(*ring->find("alice")->until_s, utc_now_s() + 89 * 86'400);
}

TEST_F(KeyCommands, TakeAPublicKeyForANewGuestOnly) {
  KeyCommand command;
  command.public_key = PrivateKey::make().public_key().text();
  command.new_room_key = "salsa";
  EXPECT_NE(error_of(command).find("--new-guest"), std::string::npos);
  command.new_room_key.clear();
  command.invite = "alice";
  command.address = "dance.example.org";
  EXPECT_NE(error_of(command).find("--new-guest"), std::string::npos);
  EXPECT_EQ(store_->read()->entries().size(), 0u);
}

TEST_F(KeyCommands, RefuseTimesThatMakeNoSense) {
  KeyCommand command;
  command.new_guest = "alice";
  for (const char* wrong : {"soon", "0d", "3651d"}) {
    command.key_for = wrong;
    const std::string error = error_of(command);
    EXPECT_NE(error.find("--key-for"), std::string::npos) << error;
    EXPECT_NE(error.find("3650d"), std::string::npos) << error;
  }
  KeyCommand invite;
  invite.invite = "alice";
  invite.address = "dance.example.org";
  invite.invitation.valid_for = "7d";
  invite.key_for = "1d";
  EXPECT_NE(error_of(invite).find("--key-for is shorter than --for"), std::string::npos);
}

}  // namespace
}  // namespace dance
