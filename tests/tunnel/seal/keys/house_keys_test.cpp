// The keys of a house, and the files that keys lie in.
#include "tunnel/seal/keys/house_keys.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/apps/run_program.h"
#include "tunnel/seal/keys/key_files.h"

namespace dance {
namespace {

HouseKey house_key(const std::string& title) {
  auto key = HouseKey::parse("dance-key:" + title + "#" + PrivateKey::make().public_key().text() +
                             "." + PrivateKey::make().text());
  if (!key) std::abort();
  return *key;
}

TEST(HouseKeys, ALineComesBack) {
  for (const char* title :
       {"alice", "alice@dance.example.org", "alice@dance.example.org:7400/salsa", "alice/salsa",
        "alice@[2001:db8::1]:7400"}) {
    const HouseKey key = house_key(title);
    EXPECT_EQ(key.title(), title);
    const auto back = HouseKey::parse("  " + key.line() + "\r\n");
    ASSERT_TRUE(back) << back.error().what;
    EXPECT_EQ(back->title(), title);
    EXPECT_EQ(back->server_key, key.server_key);
    EXPECT_TRUE(back->grant == key.grant);
    HouseKey without_grant = key;
    without_grant.grant.reset();
    const auto plain = HouseKey::parse(without_grant.line());
    ASSERT_TRUE(plain) << plain.error().what;
    EXPECT_FALSE(plain->grant);
  }
  EXPECT_EQ(house_key("alice@Dance.Example.ORG").server, "dance.example.org");
}

TEST(HouseKeys, WhatIsNoLineIsRefusedWithoutTellingTheKey) {
  const std::string key = PrivateKey::make().public_key().text(), grant = PrivateKey::make().text();
  const std::vector<std::string> all{"",
                                     "dance-key:alice",
                                     "dance-key:alice#" + key.substr(1),
                                     "alice#" + key,
                                     "dance-key:Alice#" + key,
                                     "dance-key:alice@#" + key,
                                     "dance-key:alice@a b#" + key,
                                     "dance-key:alice/ROOM#" + key,
                                     "dance-key:#" + key,
                                     "dance-key:alice#" + key + key,
                                     "dance-key:alice#" + key + ".",
                                     "dance-key:alice#." + grant,
                                     "dance-key:alice#" + grant,
                                     "dance-key:alice#" + key + "." + key,
                                     "dance-key:alice#" + key + "." + grant.substr(1),
                                     "dance-key:alice#" + key + "." + grant + "A"};
  for (const std::string& bad : all) {
    const auto parsed = HouseKey::parse(bad);
    ASSERT_FALSE(parsed) << bad;
    EXPECT_EQ(parsed.error().what.find(key.substr(1, 20)), std::string::npos);
    EXPECT_EQ(parsed.error().what.find(grant.substr(1, 20)), std::string::npos);
  }
}

TEST(HouseKeys, TheBestOneIsShown) {
  HouseKeys keys;
  for (const char* title :
       {"any", "alice@one.org", "bob@one.org:7400", "tango@one.org/tango", "carol@two.org:99"})
    keys.put(house_key(title));
  const auto name_for = [&](const char* server, const char* room, const char* guest) {
    const HouseKey* key =
        keys.find(server_name_of(server, 7400), *GuestId::parse(room), *GuestId::parse(guest));
    return key == nullptr ? std::string() : std::string(key->name.view());
  };
  EXPECT_EQ(name_for("one.org", "salsa", "alice"), "alice");
  EXPECT_EQ(name_for("ONE.org:7400", "salsa", "bob-2"), "bob");
  EXPECT_EQ(name_for("one.org", "tango", "zoe"), "tango");
  EXPECT_EQ(name_for("two.org", "salsa", "carol"), "any");
  EXPECT_EQ(name_for("two.org:99", "salsa", "carol"), "carol");
  EXPECT_EQ(name_for("three.org", "salsa", "carol"), "any");
  EXPECT_TRUE(keys.remove("any"));
  EXPECT_EQ(name_for("three.org", "salsa", "carol"), "");
  const auto back = HouseKeys::parse(keys.text(), "keys");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->text(), keys.text());
}

TEST(HouseKeys, TrustChangesTheKeyInAllLinesOfOneServer) {
  HouseKeys keys;
  const std::vector<std::string> titles{"any",
                                        "alice@one.org",
                                        "bob@one.org:7400",
                                        "bob@one.org:7411",
                                        "carol@two.org:7400",
                                        "dave@[2001:db8::1]:7400"};
  for (const std::string& title : titles) keys.put(house_key(title));
  const auto changed_by = [&](std::string_view server) {
    const HouseKeys before = keys;
    const PublicKey trusted = PrivateKey::make().public_key();
    const bool knows_another = keys.find_other(server, trusted) != nullptr;
    EXPECT_EQ(knows_another, !keys.trust(server, trusted).empty());
    EXPECT_EQ(keys.find_other(server, trusted), nullptr);
    std::vector<std::string> changed;
    for (std::size_t i = 0; i < titles.size(); ++i) {
      if (keys.keys()[i].server_key != before.keys()[i].server_key) changed.push_back(titles[i]);
      EXPECT_TRUE(keys.keys()[i].grant == before.keys()[i].grant);
    }
    return changed;
  };
  using Titles = std::vector<std::string>;
  EXPECT_EQ(changed_by("three.org"), Titles());
  EXPECT_EQ(changed_by("Two.org"), Titles{"carol@two.org:7400"});
  EXPECT_EQ(changed_by("one.org"), (Titles{"alice@one.org", "bob@one.org:7400"}));
  EXPECT_EQ(changed_by("one.org:7411"), (Titles{"alice@one.org", "bob@one.org:7411"}));
  EXPECT_EQ(changed_by("2001:db8::1"), Titles{"dave@[2001:db8::1]:7400"});
}

TEST(HouseKeys, ServersAreNamedOneWay) {
  EXPECT_EQ(server_name_of("Dance.example.org", 7400), "dance.example.org:7400");
  EXPECT_EQ(server_name_of("dance.example.org:1", 7400), "dance.example.org:1");
  EXPECT_EQ(server_name_of("::1", 7400), "[::1]:7400");
  EXPECT_EQ(server_name_of("[::1]", 7400), "[::1]:7400");
  EXPECT_EQ(server_name_of("[::1]:5", 7400), "[::1]:5");
  EXPECT_EQ(host_of("dance.example.org:1"), "dance.example.org");
  EXPECT_EQ(host_of("[::1]:5"), "::1");
  EXPECT_EQ(host_of("192.0.2.1"), "192.0.2.1");
}

class KeyFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* before = std::getenv("XDG_CONFIG_HOME");
    if (before != nullptr) config_before = before;
    setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
  }
  void TearDown() override {
    if (config_before)
      setenv("XDG_CONFIG_HOME", config_before->c_str(), 1);
    else
      unsetenv("XDG_CONFIG_HOME");
  }
  const TestFolder own{"keys"};
  const std::string folder = own.path();
  std::optional<std::string> config_before;
};

TEST_F(KeyFiles, AreForTheirOwnerAloneAndReplacedWhole) {
  const std::string path = folder + "/deep/er/keys";
  ASSERT_TRUE(write_secret(path, "one"));
  ASSERT_TRUE(write_secret(path, "two"));
  struct stat about {};
  ASSERT_EQ(stat(path.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0600u);
  const auto text = read_secret(path);
  ASSERT_TRUE(text);
  EXPECT_EQ(text->value_or(""), "two");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder + "/deep/er"), {}), 1);
  chmod(path.c_str(), 0640);
  const auto open = read_secret(path);
  ASSERT_FALSE(open);
  EXPECT_NE(open.error().what.find("chmod 600"), std::string::npos);
  EXPECT_FALSE(read_secret(folder));
  const auto none = read_secret(folder + "/none");
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
}

TEST_F(KeyFiles, AHouseHasOneIdentityAndAServerAnother) {
  const auto house = house_identity();
  const auto server = server_identity(folder + "/dance/server-keys");
  ASSERT_TRUE(house && server);
  EXPECT_TRUE(*house == *house_identity());
  EXPECT_TRUE(*server == *server_identity(folder + "/dance/other-keys")) << "one for each folder";
  EXPECT_FALSE(*house == *server);
  for (const char* name : {"identity.key", "server-identity.key"}) {
    struct stat about {};
    ASSERT_EQ(stat((folder + "/dance/" + name).c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777, 0600u) << name;
  }
}

TEST_F(KeyFiles, AllProgramsOfAMachineFindOneLocalKey) {
  std::array<std::string, 8> found;
  std::vector<std::thread> programs;
  for (std::string& key : found)
    programs.emplace_back([&key] {
      const auto made = local_key();
      if (made) key = made->text();
    });
  for (std::thread& program : programs) program.join();
  for (const std::string& key : found) EXPECT_EQ(key, found[0]);
  EXPECT_EQ(found[0].size(), PresharedKey::kTextLength);
  std::ofstream(folder + "/dance/local.key") << "damaged";
  const auto damaged = local_key();
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().what.find("remove it"), std::string::npos);
}

}  // namespace
}  // namespace dance
