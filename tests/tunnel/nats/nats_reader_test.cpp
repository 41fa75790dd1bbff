#include "tunnel/nats/messages/nats_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace dance {
namespace {

using Kind = NatsReader::Kind;

void feed(NatsReader& reader, std::string_view text) {
  const auto room = reader.room();
  ASSERT_GE(room.size(), text.size());
  std::copy(text.begin(), text.end(), room.begin());
  reader.add(text.size());
}
std::string payload_of(const NatsReader::Item& item) {
  return {item.payload.begin(), item.payload.end()};
}

TEST(NatsReader, CutsTheStreamIntoItsItems) {
  NatsReader reader;
  feed(reader,
       "INFO {\"server_id\":\"x\"}\r\nMSG dance.1.beat 7 5\r\nab\r\nc\r\n"
       "MSG dance.1.to.1 12 _INBOX.reply 0\r\n\r\nPING\r\nPONG\r\n+OK\r\n-ERR 'Permissions'\r\n");
  std::vector<Kind> kinds;
  while (const auto item = reader.next()) {
    kinds.push_back(item->kind);
    if (kinds.size() == 2) {
      EXPECT_EQ(item->text, "dance.1.beat");
      EXPECT_EQ(item->subscription, 7u);
      EXPECT_EQ(payload_of(*item), "ab\r\nc") << "a line's end within is none";
    }
    if (kinds.size() == 3) {
      EXPECT_EQ(item->subscription, 12u);
      EXPECT_TRUE(item->payload.empty());
    }
  }
  EXPECT_EQ(kinds, (std::vector{Kind::kOther, Kind::kMessage, Kind::kMessage, Kind::kPing,
                                Kind::kPong, Kind::kOther, Kind::kError}));
  EXPECT_FALSE(reader.is_broken());
}

TEST(NatsReader, AnyCutGivesTheSame) {
  std::string stream;
  for (int i = 0; i < 20; ++i)
    stream += "MSG dance.1.pose.salsa.guest-" + std::to_string(i) + " " + std::to_string(i) + " " +
              std::to_string(i * 7) + "\r\n" + std::string(static_cast<std::size_t>(i * 7), 'x') +
              "\r\n";
  for (const std::size_t step : {1u, 2u, 3u, 17u, 64u, 1000u}) {
    NatsReader reader;
    std::uint32_t next = 0;
    for (std::size_t at = 0; at < stream.size(); at += step) {
      feed(reader, std::string_view(stream).substr(at, step));
      while (const auto item = reader.next()) {
        EXPECT_EQ(item->subscription, next);
        EXPECT_EQ(item->payload.size(), next * 7);
        ++next;
      }
    }
    EXPECT_EQ(next, 20u) << step;
  }
}

TEST(NatsReader, PassesOverWhatIsTooLong) {
  NatsReader reader;
  feed(reader, "MSG a 1 100000\r\n");
  auto item = reader.next();
  ASSERT_TRUE(item);
  EXPECT_EQ(item->kind, Kind::kTooLong);
  const std::string much(50'001, 'P');
  feed(reader, much);
  EXPECT_FALSE(reader.next());
  feed(reader, much + "PING\r\n");
  item = reader.next();
  ASSERT_TRUE(item);
  EXPECT_EQ(item->kind, Kind::kPing);
  EXPECT_FALSE(reader.is_broken());
}

TEST(NatsReader, LooksAtAllBeforeAnyIsTaken) {
  NatsReader reader;
  feed(reader, "PING\r\nPONG\r\nMSG a 1 2\r\n");
  EXPECT_EQ(reader.next()->kind, Kind::kPing);
  EXPECT_EQ(reader.next()->kind, Kind::kPong);
  EXPECT_FALSE(reader.next());
  reader.rewind();
  EXPECT_EQ(reader.next()->kind, Kind::kPing);
  EXPECT_EQ(reader.next()->kind, Kind::kPong);
  feed(reader, "hi\r\n");
  EXPECT_EQ(payload_of(*reader.next()), "hi");
}

TEST(NatsReader, AStreamOfSomethingElseIsBroken) {
  for (const char* text : {"HTTP/1.1 400 Bad Request\r\n", "MSG a\r\n", "MSG a x 3\r\n",
                           "MSG a 1 -3\r\n", "MSG a 1 99999999999999999999999\r\n", "\r\n"}) {
    NatsReader reader;
    feed(reader, text);
    EXPECT_FALSE(reader.next()) << text;
    EXPECT_TRUE(reader.is_broken()) << text;
    reader.clear();
    feed(reader, "PING\r\n");
    EXPECT_TRUE(reader.next()) << "another connection";
  }
  NatsReader endless;
  for (int i = 0; i < 100 && !endless.is_broken(); ++i) {
    feed(endless, std::string(1000, 'I'));
    EXPECT_FALSE(endless.next());
  }
  EXPECT_TRUE(endless.is_broken()) << "a line without an end";
}

}  // namespace
}  // namespace dance
