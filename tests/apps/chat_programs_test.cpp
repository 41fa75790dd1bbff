// Tests lines and signs between the programs of two houses, and in the recording of one of them.
#include "formats/log/log_file.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr const char* kServer = "127.0.0.1:7458";

class ChatPrograms : public BusPrograms {
 protected:
  void start_link(const char* bus, const std::string& guest) {
    start("dance-link", {"--server", kServer, "--room", "salsa", "--guest", guest, "--bus", bus,
                         "--bus-captures", guest});
  }
  static Chat chat_of(ChatKind kind, std::string_view text = "") {
    Chat chat{mono_now(), this_clock_id(), kind, {}};
    EXPECT_TRUE(chat.text.assign(text));
    return chat;
  }
  std::string talk() const { return text_of(folder_.path("talk")); }
};

TEST_F(ChatPrograms, LinesReachTheOtherHouseOnceAndItsRecording) {
  start("dance-server", {"--port", "7458"});
  start_link(kBus, "alice");
  start_link(kOtherBus, "bob");
  const std::string log = folder_.path("evening.lcm");
  ChildProcess& record = start("dance-record", {"-o", log, "--bus", kOtherBus});
  auto ours = Bus::open(kBus), theirs = Bus::open(kOtherBus);
  ASSERT_TRUE(ours && theirs);
  std::vector<std::pair<std::string, Chat>> heard;
  (*theirs)->subscribe<Chat>(Where::kGuest,
                             [&](const Channel& channel, const Chat& chat, MonoTime) {
                               heard.emplace_back(channel.view(), chat);
                             });
  const auto write = [&](const Chat& chat) {
    (*ours)->publish(Where::kCapture, *GuestId::parse("alice"), chat);
  };
  // The houses need a moment to connect, so signs are sent until one arrives.
  ASSERT_TRUE(wait_for([&] {
    write(chat_of(ChatKind::kHeart));
    (*theirs)->drain(mono_now());
    return !heard.empty();
  })) << talk();
  EXPECT_EQ(heard[0].first, "CHAT/guest/alice");
  EXPECT_EQ(heard[0].second.kind, ChatKind::kHeart);
  heard.clear();
  const auto count_lines = [&] {
    (*theirs)->drain(mono_now());
    return std::ranges::count_if(heard, [](const auto& it) { return it.second.is_line(); });
  };
  // A line that would clear a screen is not decoded, and so not sent.
  Chat hostile = chat_of(ChatKind::kLine, "x");
  MessageBuffer buffer;
  const std::size_t size = encode(hostile, buffer);
  buffer[25] = 0x1b;
  (*ours)->publish_raw("CHAT/capture/alice", buffer.data(), size);
  write(chat_of(ChatKind::kLine, "\xc2\xa1hola!"));
  write(chat_of(ChatKind::kLine,
                "\xc2\xbf"
                "bailas?"));
  ASSERT_TRUE(wait_for([&] { return count_lines() == 2; })) << talk();
  std::erase_if(heard, [](const auto& it) { return !it.second.is_line(); });
  EXPECT_EQ(heard[0].second.text, "\xc2\xa1hola!");
  EXPECT_EQ(heard[1].second.text,
            "\xc2\xbf"
            "bailas?");
  EXPECT_EQ(heard[1].second.clock_id, this_clock_id());
  EXPECT_LT((mono_now() - heard[1].second.time).as_seconds(), 30.0);
  const std::string program = bin("dance-chat") + " --bus " + quoted(kBus) + " alice ";
  EXPECT_EQ(run(program + "'from a terminal'").exit_code, 0);
  ASSERT_TRUE(wait_for([&] { return count_lines() == 3; })) << talk();
  EXPECT_EQ(heard.back().second.text, "from a terminal");
  for (const char* wrong : {"", "hola --heart", "--heart --applause", "\"$(printf 'a\\033[2J')\""})
    EXPECT_EQ(run(program + wrong).exit_code, 2) << wrong;
  // States are repeated; lines are not.
  const MonoTime until = mono_now() + Duration::s(2);
  ASSERT_TRUE(wait_for([&] { return mono_now() > until; }));
  EXPECT_EQ(count_lines(), 3);

  record.stop(Duration::s(5));
  auto reader = LogReader::open(log);
  ASSERT_TRUE(reader) << reader.error().what;
  std::vector<std::string> recorded;
  while (const auto event = reader->next()) {
    Chat chat;
    if (event->channel == "CHAT/guest/alice" &&
        decode(event->data.data(), event->data.size(), chat) == Decoded::kFine && chat.is_line())
      recorded.emplace_back(chat.text.view());
  }
  EXPECT_EQ(recorded, (std::vector<std::string>{"\xc2\xa1hola!",
                                                "\xc2\xbf"
                                                "bailas?",
                                                "from a terminal"}));
}

}  // namespace
}  // namespace dance
