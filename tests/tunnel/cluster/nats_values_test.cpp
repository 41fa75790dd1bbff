// Values over a real NATS server, in one process: a watch, a store or a connection that ends while
// values and answers come in leaves nothing behind that the client library's threads still use.
#include "tunnel/nats/values/nats_values.h"

#include <dlfcn.h>

#include "tests/tunnel/cluster/nats_cluster.h"
#include "tunnel/nats/values/nats_store.h"

namespace dance {
namespace {

constexpr const char* kNoWayIn = "this libnats cannot be told to read slowly";

// The library's reading thread takes so long between finding whose a message is and handing it
// over, which else is a microsecond: its own tests' way in, where this version has it.
bool slow_down_reading(natsConnection* connection) {
  using Filter = void (*)(natsConnection*, natsMsg**, void*);
  const auto set = reinterpret_cast<void (*)(natsConnection*, Filter, void*)>(
      ::dlsym(RTLD_DEFAULT, "natsConn_setFilterWithClosure"));
  if (set == nullptr) return false;
  set(
      connection,
      [](natsConnection*, natsMsg**, void*) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      },
      nullptr);
  return true;
}

class NatsValuesTest : public NatsCluster {
 protected:
  struct Values {
    NatsHandle<natsConnection> connection;
    std::unique_ptr<NatsValues> values;
    ~Values() {
      if (values) values->end();
      if (connection) close_nats(connection.get());
    }
  };

  NatsOptions options() const {
    NatsOptions of;
    of.urls = nats_urls(urls());
    return of;
  }
  std::unique_ptr<Values> open() {
    auto opened = std::make_unique<Values>();
    auto connection = connect_nats(options(), {});
    if (!connection) {
      ADD_FAILURE() << connection.error().what;
      return nullptr;
    }
    opened->connection = std::move(*connection);
    auto values = NatsValues::open(opened->connection.get(), inbox(), options());
    if (!values) {
      ADD_FAILURE() << values.error().what;
      return nullptr;
    }
    opened->values = std::move(*values);
    return opened;
  }
  static void put_some(NatsValues& values, const std::string& before) {
    const std::vector<std::uint8_t> value(200, 7);
    for (int i = 0; i < 50; ++i) values.put(before + std::to_string(i), value);
  }
  // As a bus's: the library's threads may be in a callback when a test ends.
  static NatsInbox& inbox() {
    static auto& of_all = *new NatsInbox(*WakeEvent::create());
    return of_all;
  }
  static std::size_t wait_for_values(std::chrono::milliseconds longest) {
    std::size_t number = 0;
    for (const auto end = std::chrono::steady_clock::now() + longest;
         std::chrono::steady_clock::now() < end && number == 0;
         std::this_thread::sleep_for(std::chrono::milliseconds(1)))
      number += inbox().take().size();
    return number;
  }
};

TEST_F(NatsValuesTest, AWatchEndsWhileValuesComeIn) {
  start_nats(0, 1);
  const auto writer = open(), reader = open();
  ASSERT_TRUE(writer && reader);
  if (!slow_down_reading(reader->connection.get())) GTEST_SKIP() << kNoWayIn;
  std::size_t values = 0;
  for (int i = 0; i < 20; ++i) {
    put_some(*writer->values, "room.");
    reader->values->watch("room.>");
    values += wait_for_values(std::chrono::seconds(5));
    reader->values->end_watch("room.>");
  }
  EXPECT_GE(values, 20u);
  EXPECT_EQ(writer->values->failed() + reader->values->failed(), 0u);
}

TEST_F(NatsValuesTest, AConnectionEndsWhileItsAnswersComeIn) {
  start_nats(0, 1);
  const auto writer = open();
  ASSERT_TRUE(writer);
  for (int i = 0; i < 20; ++i) {
    const auto ending = open();
    ASSERT_TRUE(ending);
    if (!slow_down_reading(ending->connection.get())) GTEST_SKIP() << kNoWayIn;
    ending->values->watch("room.>");
    put_some(*writer->values, "room.");
    put_some(*ending->values, "other.");
    EXPECT_GT(wait_for_values(std::chrono::seconds(5)), 0u);
  }
}

TEST_F(NatsValuesTest, AStoreIsReadWhileOthersWrite) {
  start_nats(0, 1);
  const auto writer = open();
  ASSERT_TRUE(writer);
  const auto store = NatsStore::connect(options());
  ASSERT_TRUE(store) << store.error().what;
  for (int i = 0; i < 20; ++i) {
    put_some(*writer->values, "room.");
    const auto read = (*store)->read_all();
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_LE(read->size(), 50u);
  }
  writer->values->flush(std::chrono::seconds(5));
  const auto read = (*store)->read_all();
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->size(), 50u);
}

}  // namespace
}  // namespace dance
