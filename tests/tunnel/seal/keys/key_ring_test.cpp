// Keys and the file that holds them.
#include "tunnel/seal/keys/key_ring.h"

#include <gtest/gtest.h>

#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

TEST(PresharedKey, TextBringsItBackAndNothingElseDoes) {
  for (int i = 0; i < 200; ++i) {
    const PresharedKey key = PresharedKey::make();
    const std::string text = key.text();
    ASSERT_EQ(text.size(), PresharedKey::kTextLength);
    const auto back = PresharedKey::parse(text);
    ASSERT_TRUE(back);
    EXPECT_TRUE(*back == key);
    EXPECT_FALSE(PresharedKey::parse(text.substr(1)));
    EXPECT_FALSE(PresharedKey::parse(text + "A"));
    EXPECT_FALSE(*PresharedKey::parse(PresharedKey::make().text()) == key);
  }
  EXPECT_FALSE(PresharedKey::parse(std::string(43, '=')));
  EXPECT_FALSE(PresharedKey::parse(std::string(42, 'A') + "B"));  // bits that say nothing
  EXPECT_TRUE(PresharedKey::parse(std::string(43, 'A')));
}

TEST(KeyRing, KeepsWhatItWrote) {
  KeyRing ring;
  KeyEntry entry;
  entry.name = *GuestId::parse("bob");
  entry.kind = KeyKind::kHost;
  entry.room = *GuestId::parse("salsa");
  entry.key = PrivateKey::make().public_key();
  EXPECT_TRUE(ring.add(entry));
  EXPECT_FALSE(ring.add(entry));
  entry.name = *GuestId::parse("alice");
  entry.room = GuestId();
  entry.kind = KeyKind::kListener;
  entry.key = PrivateKey::make().public_key();
  EXPECT_TRUE(ring.add(entry));
  const auto back = KeyRing::parse(ring.text(), "keys");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->entries(), ring.entries());
  ASSERT_NE(back->find("alice"), nullptr);
  EXPECT_TRUE(*back->find("alice") == entry);
  EXPECT_EQ(back->find("alic"), nullptr);
  EXPECT_EQ(back->find(""), nullptr);
  EXPECT_TRUE(ring.remove("bob"));
  EXPECT_FALSE(ring.remove("bob"));
}

TEST(KeyRing, KnowsWhoseNamesAreTaken) {
  KeyRing ring;
  KeyEntry entry;
  entry.name = *GuestId::parse("ann-lee");
  ASSERT_TRUE(ring.add(entry));
  entry.name = *GuestId::parse("salsa");
  entry.kind = KeyKind::kRoom;
  ASSERT_TRUE(ring.add(entry));
  EXPECT_TRUE(ring.is_own_name("ann-lee"));
  EXPECT_TRUE(ring.is_own_name("ann-lee-2"));
  EXPECT_FALSE(ring.is_own_name("ann"));
  EXPECT_FALSE(ring.is_own_name("ann-leeds"));
  EXPECT_FALSE(ring.is_own_name("salsa"));
  EXPECT_FALSE(ring.is_own_name("-"));
}

TEST(KeyRing, SaysWhichLineIsWrongAndNeverTheKey) {
  const std::string key = PrivateKey::make().public_key().text();
  const auto error_of = [](const std::string& text) {
    const auto ring = KeyRing::parse(text, "keys");
    return ring ? std::string() : ring.error().what;
  };
  EXPECT_EQ(error_of("# nothing\n\n  alice guest * " + key + "\r\n"), "");
  const auto says = [&](const std::string& text, const std::string& part) {
    const std::string error = error_of(text);
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(error.find(key.substr(0, 20)), std::string::npos) << error;
  };
  says("\nalice guest *", "keys line 2: a line is NAME KIND ROOM KEY");
  says("alice guest * " + key + " more", "NAME KIND ROOM KEY");
  says("Alice guest * " + key, "'Alice'");
  says("alice king * " + key, "'king' is none of guest");
  says("alice guest A " + key, "room: 'A'");
  says("alice guest " + key + " *", "room: a long word");
  says(key + " guest * alice", "name: a long word");
  says("alice " + key + " guest *", "kind: a long word");
  says("alice guest * " + key + "x", "none");
  says("alice guest * " + key + "\nalice host * " + key, "line 2: 'alice' has a key already");
}

TEST(KeyRing, KeepsTheExpiryOfAKey) {
  const std::string key = PrivateKey::make().public_key().text(),
                    other = PrivateKey::make().public_key().text();
  const std::string text = "alice guest * " + key + " until 20261231T2359Z\n" +
                           "bob host salsa - invited " + other + " 20261127T0800Z until " +
                           "20270101T0000Z\n" + "carol guest * " + other + "\n";
  const auto ring = KeyRing::parse(text, "keys");
  ASSERT_TRUE(ring) << ring.error().what;
  const KeyEntry* alice = ring->find("alice");
  ASSERT_NE(alice, nullptr);
  ASSERT_TRUE(alice->until_s);
  EXPECT_EQ(utc_text(*alice->until_s), "20261231T2359Z");
  EXPECT_FALSE(alice->has_expired(*alice->until_s - 1));
  EXPECT_TRUE(alice->has_expired(*alice->until_s));
  ASSERT_NE(ring->find_invitation("bob"), nullptr);
  EXPECT_EQ(utc_text(*ring->find_invitation("bob")->until_s), "20270101T0000Z");
  EXPECT_FALSE(ring->find("carol")->has_expired(INT64_MAX)) << "no key expires unless it says so";
  const auto back = KeyRing::parse(ring->text(), "keys");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->entries(), ring->entries());
  for (const char* wrong : {" until", " until tomorrow", " until 20261332T0000Z",
                            " until 20261231T2359Z more", " untill 20261231T2359Z"}) {
    const auto parsed = KeyRing::parse("alice guest * " + key + wrong, "keys");
    ASSERT_FALSE(parsed) << wrong;
    EXPECT_NE(parsed.error().what.find("keys line 1"), std::string::npos) << parsed.error().what;
    EXPECT_EQ(parsed.error().what.find(key), std::string::npos);
  }
}

TEST(KeyRing, ReplacesAnExpiredKey) {
  KeyRing ring;
  KeyEntry alice;
  alice.name = *GuestId::parse("alice");
  alice.key = PrivateKey::make().public_key();
  alice.until_s = 1000;
  ASSERT_TRUE(ring.add(alice));
  KeyEntry again = alice;
  again.key = PrivateKey::make().public_key();
  ring.remove_expired("alice", 999);
  EXPECT_FALSE(ring.add(again)) << "it is still good";
  ring.remove_expired("alice", 1000);
  EXPECT_TRUE(ring.add(again));
  EXPECT_TRUE(ring.find("alice")->key == again.key);
}

}  // namespace
}  // namespace dance
