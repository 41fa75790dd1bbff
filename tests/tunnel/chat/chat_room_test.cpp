// Tests chat and signs from house to house: each arrives once, whatever the path loses, and no
// guest sends more than a line and a sign a second.
#include "tests/tunnel/states_scene.h"
#include "tunnel/wire/wire_chat.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

class ChatRoom : public StatesScene {
 protected:
  void write(House& house, std::string_view who, std::string_view text) {
    Chat chat = stamped(house, ChatKind::kLine);
    ASSERT_TRUE(chat.text.assign(text));
    say(house, who, chat);
  }
  void sign(House& house, std::string_view who, ChatKind kind) {
    say(house, who, stamped(house, kind));
  }
  Chat stamped(const House& house, ChatKind kind) {
    Chat chat;
    chat.time = tunnel.time_in(house);
    chat.clock_id = house.clock_id;
    chat.kind = kind;
    return chat;
  }
  // "alice: hola", "bob <3".
  static std::vector<std::string> read(const House& house) {
    std::vector<std::string> all;
    for (const auto& [guest, chat] : house.chats)
      all.push_back(std::string(guest.view()) +
                    (chat.kind == ChatKind::kHeart      ? " <3"
                     : chat.kind == ChatKind::kApplause ? " claps"
                                                        : ": ") +
                    std::string(chat.text.view()));
    return all;
  }
  // Sends bytes past the link, as a guest's other program could.
  void inject(const House& house, std::uint32_t version, wire::Bytes payload) {
    std::array<std::uint8_t, wire::kMaxPlain> bytes;
    ByteWriter out(bytes);
    wire::begin_states(wire::Type::kState, out);
    wire::add_state({{wire::StateKind::kChat, 0}, {0, 0}, {}, version, payload}, out);
    tunnel.inject(house.peer, out.written());
  }
  void inject(const House& house, std::uint32_t version, std::uint32_t sequence,
              std::size_t entries, std::string_view text) {
    wire::ChatHistory history;
    history.sequence = sequence;
    Chat line;
    line.time = tunnel.now();
    ASSERT_TRUE(line.text.assign(text));
    for (std::size_t i = 0; i < entries; ++i) ASSERT_TRUE(history.entries.try_push(line));
    std::array<std::uint8_t, wire::kMaxStatePayload> payload;
    const std::size_t size = wire::build(history, payload);
    inject(house, version, wire::Bytes(payload).first(size));
  }
  std::uint64_t rejected(ServerReject cause) { return tunnel.server().counters().of(cause); }
};

TEST_F(ChatRoom, LinesAndSignsReachAllOthersOnce) {
  House& a = tunnel.add_house("salsa", {"alice"}, Duration::s(400));
  House& b = tunnel.add_house("salsa", {"bob"}, Duration::s(-77));
  House& c = tunnel.add_house("salsa", {}, Duration::s(3));
  House& d = tunnel.add_house("tango", {"dora"});
  tunnel.run(Duration::ms(200));
  write(a, "alice", "hola");
  sign(a, "alice", ChatKind::kHeart);
  tunnel.run(Duration::ms(100));
  const MonoTime written = tunnel.time_in(c);
  write(b, "bob", "\xc2\xa1hey!");
  tunnel.run(Duration::ms(300));
  sign(b, "bob", ChatKind::kApplause);
  tunnel.run(Duration::s(2));
  EXPECT_EQ(read(c), (std::vector<std::string>{"alice: hola", "alice <3", "bob: \xc2\xa1hey!",
                                               "bob claps"}));
  EXPECT_EQ(read(a), (std::vector<std::string>{"bob: \xc2\xa1hey!", "bob claps"}));
  EXPECT_EQ(read(b), (std::vector<std::string>{"alice: hola", "alice <3"}));
  EXPECT_TRUE(d.chats.empty()) << "another room";
  ASSERT_EQ(c.chats.size(), 4u);
  EXPECT_EQ(c.chats[2].second.clock_id, c.clock_id);
  EXPECT_LT(std::abs((c.chats[2].second.time - written).as_ms()), 40.0) << "in the reader's clock";
}

TEST_F(ChatRoom, LossyPathsLoseNoLine) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  lose(0.4);
  std::vector<std::string> expected;
  for (int i = 0; i < 30; ++i) {
    const std::string text = "line " + std::to_string(i);
    write(a, "alice", text);
    expected.push_back("alice: " + text);
    tunnel.run(Duration::ms(1050));
  }
  lose(0.0);
  tunnel.run(Duration::s(1));
  EXPECT_EQ(read(b), expected);
}

TEST_F(ChatRoom, LinesOfALapseArriveAfterIt) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  write(a, "alice", "0");
  tunnel.run(Duration::ms(1500));
  lose(1.0);
  for (const char* text : {"1", "2", "3"}) {
    write(a, "alice", text);
    tunnel.run(Duration::ms(1100));
  }
  lose(0.0);
  tunnel.run(Duration::s(3));
  EXPECT_EQ(read(b), (std::vector<std::string>{"alice: 0", "alice: 1", "alice: 2", "alice: 3"}));
}

TEST_F(ChatRoom, RestartedServersAndHousesRepeatNoLine) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  write(a, "alice", "before");
  tunnel.run(Duration::s(2));
  tunnel.stop_server();
  tunnel.run(Duration::ms(300));
  tunnel.start_server();
  tunnel.run(Duration::s(4));
  ASSERT_TRUE(a.link->is_connected() && b.link->is_connected());
  write(a, "alice", "after");
  tunnel.run(Duration::ms(500));
  EXPECT_EQ(read(b), (std::vector<std::string>{"alice: before", "alice: after"}));
  tunnel.start_link(a, "salsa", {"alice"});
  tunnel.run(Duration::s(5));
  write(a, "alice", "again");
  tunnel.run(Duration::ms(500));
  EXPECT_EQ(read(b).back(), "alice: again");
  EXPECT_EQ(b.chats.size(), 3u);
}

TEST_F(ChatRoom, NewcomersReceiveLinesOfTheLastHalfMinute) {
  House& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(200));
  write(a, "alice", "old");
  tunnel.run(Duration::s(25));
  write(a, "alice", "new");
  tunnel.run(Duration::s(10));
  House& b = tunnel.add_house("salsa", {"bob"}, Duration::s(50));
  tunnel.run(Duration::s(1));
  ASSERT_EQ(read(b), std::vector<std::string>{"alice: new"});
  const double age_s = (tunnel.time_in(b) - b.chats[0].second.time).as_seconds();
  EXPECT_GT(age_s, 10.0);
  EXPECT_LT(age_s, 12.0);
}

TEST_F(ChatRoom, OneGuestsFloodCostsTheOthersNothing) {
  House& mallory = tunnel.add_house("salsa", {"mallory"});
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  mallory.is_running = false;  // the test sends in its session instead
  std::uint32_t version = 1, sequence = 1;
  for (int second = 0; second < 10; ++second) {
    write(a, "alice", std::to_string(second));
    for (int i = 0; i < 100; ++i) {
      const std::size_t entries = 1 + static_cast<std::size_t>(i) % 4;
      sequence += static_cast<std::uint32_t>(entries);
      inject(mallory, version++, sequence, entries, "buy");
      tunnel.run(Duration::ms(1));
    }
    // Alice's line has arrived meanwhile.
    EXPECT_EQ(std::ranges::count_if(b.chats,
                                    [](const auto& chat) { return chat.first == guest("alice"); }),
              second + 1);
    mallory.is_running = true;
    tunnel.run(Duration::ms(950));
    mallory.is_running = false;
  }
  const auto bought = std::ranges::count_if(
      b.chats, [](const auto& chat) { return chat.first == guest("mallory"); });
  EXPECT_GE(bought, 4);
  EXPECT_LE(bought, 14) << "one a second, and four at first";
  EXPECT_GT(rejected(ServerReject::kChatRate), 300u);
  EXPECT_EQ(b.link->counters().chats_limited, 0u) << "the server has dropped them";
}

TEST_F(ChatRoom, ServerRefusesHistoriesThatGoBack) {
  House& mallory = tunnel.add_house("salsa", {"mallory"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  inject(mallory, 1, 100, 1, "one");
  tunnel.run(Duration::ms(100));
  inject(mallory, 2, 99, 4, "back");
  inject(mallory, 3, 100, 4, "more of the same");
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(read(b), std::vector<std::string>{"mallory: one"});
  EXPECT_GE(rejected(ServerReject::kMalformed), 2u);
}

TEST_F(ChatRoom, ServerRefusesInvalidLines) {
  House& mallory = tunnel.add_house("salsa", {"mallory"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  std::uint32_t number = 1;
  const std::string long_line(kMaxChatCharacters + 1, 'x');
  for (const std::string& text :
       {std::string("\xe2\x80\xae"
                    "evil"),
        std::string("\x1b[2J"), std::string("a\nb"), std::string("\xff\xfe"), long_line}) {
    inject(mallory, number, number, 1, text);
    ++number;
    tunnel.run(Duration::ms(20));
  }
  EXPECT_TRUE(b.chats.empty());
  EXPECT_EQ(rejected(ServerReject::kMalformed), 5u);
  EXPECT_EQ(tunnel.server().counters().states_in, 0u);
}

TEST_F(ChatRoom, LinkSendsNoMoreThanAGuestMayWrite) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  for (int i = 0; i < 40; ++i) {
    write(a, "alice", std::to_string(i));
    sign(a, "alice", ChatKind::kHeart);
    tunnel.run(Duration::ms(100));
  }
  EXPECT_LE(b.chats.size(), 16u);
  EXPECT_GT(a.link->counters().chats_limited, 60u);
  EXPECT_EQ(rejected(ServerReject::kChatRate), 0u);
  Chat bad = stamped(a, ChatKind::kLine);
  const std::uint64_t invalid = a.link->counters().states_invalid;
  say(a, "alice", bad);
  EXPECT_EQ(a.link->counters().states_invalid, invalid + 1) << "a line without text";
  say(a, "nobody", stamped(a, ChatKind::kHeart));
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(
      std::ranges::all_of(b.chats, [](const auto& chat) { return chat.first == guest("alice"); }));
}

}  // namespace
}  // namespace dance
