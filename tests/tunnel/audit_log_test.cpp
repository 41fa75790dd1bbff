// The audit log: its bounds, its fairness, its text, and its file.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/test_folder.h"
#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/seal/keys/utc_text.h"
#include "tunnel/server/program/audit_keeper.h"

namespace dance {
namespace {

constexpr std::int64_t kNow_s = 1'800'000'000;

Address address(const std::string& text) { return *Address::resolve(text); }

AuditEvent join_of(std::string_view key) {
  AuditEvent event{.kind = AuditKind::kJoined, .key = key, .room = guest("salsa")};
  if (!event.guests.try_push(guest("alice"))) std::abort();
  return event;
}

AuditEvent refusal_of(std::string_view key, std::string_view cause = "wrong_key") {
  return {.kind = AuditKind::kRefused, .key = key, .cause = cause};
}

AuditEvent removal_of(std::string_view key, std::string_view host) {
  return {.kind = AuditKind::kRemoved, .key = key, .cause = "by_host", .by = guest(host)};
}

std::vector<AuditEntry> entries_of(const AuditLog& log) {
  std::vector<AuditEntry> entries;
  for (const auto& line : log.lines()) {
    const auto entry = parse_audit_line(*line);
    EXPECT_TRUE(entry) << *line;
    if (entry) entries.push_back(*entry);
  }
  return entries;
}

std::size_t count_of(const AuditLog& log, const std::function<bool(const AuditEntry&)>& is_meant) {
  const auto entries = entries_of(log);
  return static_cast<std::size_t>(std::ranges::count_if(entries, is_meant));
}

TEST(AuditLog, SumsRefusalsOfOneNetworkByCause) {
  AuditLog log;
  for (int i = 0; i < 500; ++i)
    log.add(address("192.0.2.7:" + std::to_string(1000 + i)), refusal_of("alice"), kNow_s + i);
  log.add(address("192.0.2.7:9"), refusal_of("alice", "unknown_name"), kNow_s);
  log.add(address("192.0.2.8:9"), refusal_of("alice"), kNow_s);
  // Two addresses of one IPv6 /64 are one network.
  log.add(address("[2001:db8::1]:9"), refusal_of("alice"), kNow_s);
  log.add(address("[2001:db8::2]:9"), refusal_of("alice"), kNow_s + 1);
  const auto entries = entries_of(log);
  ASSERT_EQ(entries.size(), 4u);
  EXPECT_EQ(entries[0].count, 500u);
  EXPECT_EQ(entries[0].first_s, kNow_s);
  EXPECT_EQ(entries[0].last_s, kNow_s + 499);
  EXPECT_EQ(entries[0].address, "192.0.2.7:1499");
  EXPECT_EQ(entries[3].count, 2u);
  EXPECT_EQ(entries[3].network, "2001:db8::/64");
}

TEST(AuditLog, ARefusalFloodPushesOutNoJoinNoRemovalAndNoRefusalOfAnotherNetwork) {
  AuditLog log;
  log.add(address("192.0.2.1:1"), join_of("alice"), kNow_s);
  log.add(address("192.0.2.2:1"), removal_of("bob", "hanna"), kNow_s);
  log.add(address("198.51.100.3:1"), refusal_of("carol"), kNow_s);
  // The flood comes from 65,536 networks (/64) of one IPv6 /48.
  for (int i = 0; i < 65'536; ++i) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "[2001:db8:7:%x::1]:99", i);
    log.add(address(text.data()), refusal_of("mallory"), kNow_s + 1 + i);
  }
  EXPECT_EQ(count_of(log, [](const auto& it) { return it.kind == AuditKind::kJoined; }), 1u);
  EXPECT_EQ(count_of(log, [](const auto& it) { return it.kind == AuditKind::kRemoved; }), 1u);
  EXPECT_EQ(count_of(log, [](const auto& it) { return it.key == "carol"; }), 1u);
  EXPECT_EQ(entries_of(log).size(), 2 + AuditLog::kMostEntries[1]);
}

TEST(AuditLog, OneKeyThatJoinsAgainAndAgainPushesOutNoOtherKey) {
  AuditLog log;
  log.add(address("192.0.2.1:1"), join_of("alice"), kNow_s);
  for (int i = 0; i < 3000; ++i) {
    AuditEvent event = join_of("mallory");
    event.guests.clear();
    ASSERT_TRUE(event.guests.try_push(guest("mallory-" + std::to_string(i))));
    log.add(address("192.0.2.9:1"), event, kNow_s + i);
  }
  EXPECT_EQ(count_of(log, [](const auto& it) { return it.key == "alice"; }), 1u);
  EXPECT_EQ(entries_of(log).size(), AuditLog::kMostEntries[0]);
}

TEST(AuditLog, OneHostThatRemovesManyPushesOutNoRemovalOfAnotherHost) {
  AuditLog log;
  log.add(address("192.0.2.1:1"), removal_of("bob", "hanna"), kNow_s);
  for (int i = 0; i < 3000; ++i)
    log.add(address("192.0.2.9:1"), removal_of("guest-" + std::to_string(i), "mallory"),
            kNow_s + i);
  EXPECT_EQ(count_of(log, [](const auto& it) { return it.by == "hanna"; }), 1u);
  EXPECT_EQ(entries_of(log).size(), AuditLog::kMostEntries[2]);
}

TEST(AuditLog, OneNetworkWithARoomKeyPushesOutNoOtherNetworkWithThatKey) {
  AuditLog log;
  log.add(address("198.51.100.3:1"), join_of("salsa"), kNow_s);
  for (int i = 0; i < 3000; ++i) {
    AuditEvent event = join_of("salsa");
    event.guests.clear();
    ASSERT_TRUE(event.guests.try_push(guest("g-" + std::to_string(i))));
    log.add(address("192.0.2.9:1"), event, kNow_s + i);
  }
  EXPECT_EQ(count_of(log, [](const auto& it) { return it.network == "198.51.100.3"; }), 1u);
}

TEST(AuditLog, CountsAJoinThatRepeatsSoonAndListsALaterOne) {
  AuditLog log;
  log.add(address("192.0.2.1:1"), join_of("alice"), kNow_s);
  log.add(address("192.0.2.1:2"), join_of("alice"), kNow_s + 60);
  log.add(address("192.0.2.1:3"), join_of("alice"), kNow_s + 60 + AuditLog::kSameJoinWithin_s);
  const auto entries = entries_of(log);
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].count, 2u);
  EXPECT_EQ(entries[1].count, 1u);
}

TEST(AuditLog, EscapesAndCutsNamesOfStrangers) {
  AuditLog log;
  log.add(address("192.0.2.1:1"), refusal_of("\x1b[2Jevil\nname\xe2\x80\xae\""), kNow_s);
  log.add(address("192.0.2.2:1"), refusal_of(std::string(5000, 'x')), kNow_s);
  for (const auto& line : log.lines())
    for (const char c : *line) EXPECT_TRUE(c >= ' ' && c <= '~') << static_cast<int>(c);
  const auto entries = entries_of(log);
  EXPECT_EQ(entries[0].key, "?[2Jevil?name???\"");
  EXPECT_EQ(entries[1].key.size(), AuditLog::kLongestKey);
}

TEST(AuditLog, ALineRoundTripsAndAnythingElseIsRefused) {
  AuditEntry entry;
  entry.kind = AuditKind::kRemoved;
  entry.first_s = kNow_s;
  entry.last_s = kNow_s + 5;
  entry.count = 3;
  entry.key = "bob";
  entry.address = "192.0.2.1:7";
  entry.network = "192.0.2.1";
  entry.wide_network = "192.0.0.0/16";
  entry.room = "salsa";
  entry.guests = "bob bob-2";
  entry.cause = "by_host";
  entry.by = "hanna";
  const std::string line = audit_line(entry);
  EXPECT_EQ(parse_audit_line(line), entry);
  for (std::size_t i = 0; i < line.size(); ++i)
    EXPECT_FALSE(parse_audit_line(line.substr(0, i))) << i;
  for (const char* wrong : {"{}", "[]", "7", R"({"what":"left","first_utc_s":1,"last_utc_s":1})",
                            R"({"what":"joined","first_utc_s":1,"last_utc_s":1,"count":-1})",
                            R"({"what":"joined","first_utc_s":1,"last_utc_s":1,"count":1,"by":7})"})
    EXPECT_FALSE(parse_audit_line(wrong)) << wrong;
}

class AuditKeeperFile : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1); }
  void TearDown() override { ::unsetenv("XDG_RUNTIME_DIR"); }
  std::string file() const { return folder_.path("server-7400-log.jsonl"); }

  TestFolder folder_{"audit"};
  std::unique_ptr<Poller> poller_ = std::move(*Poller::create());
};

TEST_F(AuditKeeperFile, LiesBesideTheKeysAndIsContinuedByTheNextRun) {
  EXPECT_EQ(audit_file("/a/b/server-keys", 7400), "/a/b/server-7400-log.jsonl");
  EXPECT_EQ(audit_file("server-keys", 7400), "server-7400-log.jsonl");
  for (int i = 0; i < 2; ++i) {
    AuditKeeper keeper(file(), 7400, *poller_);
    keeper.add(address("192.0.2.1:1"), removal_of("bob", "hanna"));
  }
  struct stat about {};
  ASSERT_EQ(::stat(file().c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777u, 0600u);
  const std::string text = text_of(file());
  EXPECT_EQ(std::ranges::count(text, '\n'), 2) << text;
}

TEST_F(AuditKeeperFile, IsLeftAloneWhereOthersMayReadIt) {
  std::ofstream(file()) << "something\n";
  ASSERT_EQ(::chmod(file().c_str(), 0644), 0);
  {
    AuditKeeper keeper(file(), 7400, *poller_);
    keeper.add(address("192.0.2.1:1"), removal_of("bob", "hanna"));
  }
  EXPECT_EQ(text_of(file()), "something\n");
}

TEST_F(AuditKeeperFile, StaysBoundedWhenTheLogIsFull) {
  {
    AuditKeeper keeper(file(), 7400, *poller_);
    for (int i = 0; i < 3000; ++i) {
      AuditEvent event = join_of("a-key-of-24-characters-x");
      event.guests.clear();
      for (std::size_t j = 0; j < wire::kMaxGuestsPerLink; ++j)
        ASSERT_TRUE(event.guests.try_push(
            guest("guest-with-longer-na" + std::to_string(i + static_cast<int>(j)))));
      keeper.add(address("[2001:db8:ffff:ffff:ffff:ffff:ffff:ffff]:65535"), event);
    }
  }
  // read_secret() takes files up to this size.
  EXPECT_LT(std::filesystem::file_size(file()), 2'000'000u);
  EXPECT_EQ(std::ranges::count(text_of(file()), '\n'),
            static_cast<std::ptrdiff_t>(AuditLog::kMostEntries[0]));
}

struct AuditedTunnel {
  struct Told {
    AuditKind kind;
    std::string key, room, cause, by;
    std::vector<std::string> guests;
  };
  AuditedTunnel() {
    tunnel.server().set_on_audit([this](PeerId, const AuditEvent& event) {
      Told entry{event.kind,
                 std::string(event.key),
                 std::string(event.room.view()),
                 std::string(event.cause),
                 std::string(event.by.view()),
                 {}};
      for (const GuestId& id : event.guests) entry.guests.emplace_back(id.view());
      told.push_back(std::move(entry));
    });
  }
  SimulatedTunnel tunnel;
  std::vector<Told> told;
};

TEST(AuditEvents, ReportJoinsRefusalsAndRemovalsWithKeyRoomAndCause) {
  AuditedTunnel of;
  auto& host =
      of.tunnel.add_house("salsa", {"hanna"}, {}, {.name = guest("hanna"), .role = Role::kHost});
  of.tunnel.add_house("salsa", {"bob"}, {}, {.name = guest("bob")});
  of.tunnel.run(Duration::ms(600));
  ASSERT_EQ(of.told.size(), 2u);
  EXPECT_EQ(of.told[0].kind, AuditKind::kJoined);
  EXPECT_EQ(of.told[0].key, "hanna");
  EXPECT_EQ(of.told[0].room, "salsa");
  EXPECT_EQ(of.told[0].guests, std::vector<std::string>{"hanna"});
  of.told.clear();

  of.tunnel.add_house("salsa", {"carla"}, {}, {.name = guest("mallory")});
  of.tunnel.run(Duration::ms(600));
  ASSERT_FALSE(of.told.empty());
  EXPECT_EQ(of.told[0].kind, AuditKind::kRefused);
  EXPECT_EQ(of.told[0].key, "mallory");
  EXPECT_EQ(of.told[0].cause, "name_not_allowed");
  of.told.clear();

  host.link->ask_removal(guest("bob"), 1);
  of.tunnel.run(Duration::ms(50));
  ASSERT_EQ(std::ranges::count(of.told, AuditKind::kRemoved, &AuditedTunnel::Told::kind), 1);
  const auto removal = std::ranges::find(of.told, AuditKind::kRemoved, &AuditedTunnel::Told::kind);
  EXPECT_EQ(removal->key, "bob");
  EXPECT_EQ(removal->by, "hanna");
  EXPECT_EQ(removal->guests, std::vector<std::string>{"bob"});
}

}  // namespace
}  // namespace dance
