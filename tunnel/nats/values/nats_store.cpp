#include "tunnel/nats/values/nats_store.h"

#include <chrono>

#include "core/base/printable.h"
#include "tunnel/nats/nats_connection.h"

namespace dance {
namespace {

constexpr std::int64_t kNextValue_ms = 2000;
constexpr auto kAgrees = std::chrono::seconds(8);

class ConnectedNatsStore final : public NatsStore {
 public:
  ConnectedNatsStore(NatsOptions options, NatsHandle<natsConnection> connection, NatsBucket bucket)
      : options_(std::move(options)),
        connection_(std::move(connection)),
        bucket_(std::move(bucket)) {}
  ~ConnectedNatsStore() override { close_nats(connection_.get()); }

  // A bucket whose servers have just lost one answers when they have agreed who leads it now.
  Result<std::map<std::string, std::string>> read_all() override {
    const auto begin = std::chrono::steady_clock::now();
    for (;;) {
      auto values = read_once();
      if (values || is_refused() || std::chrono::steady_clock::now() - begin > kAgrees)
        return values;
    }
  }

  Result<std::map<std::string, std::string>> read_once() {
    kvWatcher* made = nullptr;
    if (const natsStatus status = kvStore_WatchAll(&made, bucket_.store.get(), nullptr);
        status != NATS_OK)
      return tl::make_unexpected(failure("cannot be read", status));
    ended_.emplace_back(made);
    auto values = read_watched(made);
    kvWatcher_Stop(made);
    if (reader_has_passed(connection_.get())) ended_.clear();
    return values;
  }

  Result<std::map<std::string, std::string>> read_watched(kvWatcher* watcher) {
    std::map<std::string, std::string> values;
    for (;;) {
      kvEntry* next = nullptr;
      if (const natsStatus status = kvWatcher_Next(&next, watcher, kNextValue_ms);
          status != NATS_OK)
        return tl::make_unexpected(failure("cannot be read", status));
      if (next == nullptr) return values;  // that was all
      const NatsHandle<kvEntry> entry(next);
      if (kvEntry_Operation(next) != kvOp_Put) continue;
      if (values.size() == kMost)
        return tl::make_unexpected(Error{"the bucket '" + options_.bucket +
                                         "' has more values than any of ours: who else "
                                         "writes into it?"});
      const auto size = static_cast<std::size_t>(std::max(kvEntry_ValueLen(next), 0));
      values[kvEntry_Key(next)].assign(static_cast<const char*>(kvEntry_Value(next)),
                                       std::min(size, kMostBytes));
    }
  }

  Result<bool> add(std::string_view key, std::string_view value) override {
    std::uint64_t revision = 0;
    const natsStatus status =
        kvStore_Create(&revision, bucket_.store.get(), std::string(key).c_str(), value.data(),
                       static_cast<int>(value.size()));
    if (status == NATS_OK) return true;
    // So is any other error of the stream; a value that is there says which it was.
    kvEntry* known = nullptr;
    if (kvStore_Get(&known, bucket_.store.get(), std::string(key).c_str()) == NATS_OK) {
      kvEntry_Destroy(known);
      return false;
    }
    return tl::make_unexpected(failure("cannot be written", status));
  }

  Result<void> erase(std::string_view key) override {
    if (const natsStatus status = kvStore_Delete(bucket_.store.get(), std::string(key).c_str());
        status != NATS_OK)
      return tl::make_unexpected(failure("cannot be written", status));
    return {};
  }

 private:
  bool is_refused() const {
    const char* said = nullptr;
    return natsConnection_GetLastError(connection_.get(), &said) == NATS_NOT_PERMITTED;
  }

  Error failure(const char* what, natsStatus status) const {
    const std::string of = "the bucket '" + options_.bucket + "' at " + shown_urls(options_);
    const char* said = nullptr;
    natsConnection_GetLastError(connection_.get(), &said);
    if (is_refused())
      return Error{of + " " + what +
                   " by this user: " + (said != nullptr ? printable(said) : "not permitted")};
    said = status == NATS_TIMEOUT ? nullptr : nats_GetLastError(nullptr);
    return Error{of + " " + what + " (" + natsStatus_GetText(status) +
                 (said != nullptr ? std::string(": ") + printable(said) : std::string()) +
                 "): are most of the NATS servers up?"};
  }

  NatsOptions options_;
  NatsHandle<natsConnection> connection_;
  NatsBucket bucket_;
  std::vector<NatsHandle<kvWatcher>> ended_;  // that the reading thread may still use
};

}  // namespace

Result<std::unique_ptr<NatsStore>> NatsStore::connect(const NatsOptions& options) {
  DANCE_TRY(NatsHandle<natsConnection> connection, connect_nats(options, {}));
  DANCE_TRY(NatsBucket bucket, open_nats_bucket(connection.get(), options));
  return std::make_unique<ConnectedNatsStore>(options, std::move(connection), std::move(bucket));
}

}  // namespace dance
