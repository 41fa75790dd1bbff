#include <chrono>
#include <optional>
#include <thread>

#include "core/base/printable.h"
#include "tunnel/nats/nats_connection.h"

namespace dance {
namespace {

constexpr std::int64_t kAnswer_ms = 1000;
constexpr std::int32_t kMostValueBytes = 4096;
constexpr auto kBucketRetry = std::chrono::milliseconds(100);
// NATS servers that have just started must find each other first.
constexpr auto kStart = std::chrono::seconds(10);

Error without_store(natsStatus status, const NatsOptions& options) {
  const char* detail = nats_GetLastError(nullptr);
  return Error{"the NATS server at " + shown_urls(options) + " keeps no values (" +
               natsStatus_GetText(status) +
               (detail != nullptr ? std::string(": ") + printable(detail) : std::string()) +
               "): start nats-server with -js, and let this user use JetStream"};
}

// The server said so beside the call, which was left without an answer.
std::optional<Error> refusal(natsConnection* connection, const NatsOptions& options) {
  const char* said = nullptr;
  if (natsConnection_GetLastError(connection, &said) != NATS_NOT_PERMITTED) return std::nullopt;
  return Error{"the NATS server at " + shown_urls(options) + " does not let this user use '" +
               options.bucket + "': " + (said != nullptr ? printable(said) : "not permitted")};
}

}  // namespace

Result<NatsBucket> try_nats_bucket(natsConnection* connection, const NatsOptions& options) {
  jsOptions wait;
  jsOptions_Init(&wait);
  wait.Wait = kAnswer_ms;
  jsCtx* stream = nullptr;
  if (const natsStatus status = natsConnection_JetStream(&stream, connection, &wait);
      status != NATS_OK)
    return tl::make_unexpected(without_store(status, options));
  NatsBucket bucket{NatsHandle<jsCtx>(stream), nullptr, 0};
  kvConfig config;
  kvConfig_Init(&config);
  config.Bucket = options.bucket.c_str();
  config.History = 1;
  config.MaxValueSize = kMostValueBytes;
  config.TTL = std::int64_t{options.lasts_s} * 1'000'000'000;
  config.StorageType = js_FileStorage;
  config.Replicas = options.replicas > 0 ? options.replicas : options.urls.size() >= 3 ? 3 : 1;
  kvStore* store = nullptr;
  natsStatus status = js_KeyValue(&store, stream, options.bucket.c_str());
  if (status != NATS_OK) status = js_CreateKeyValue(&store, stream, &config);
  if (status != NATS_OK) return tl::make_unexpected(without_store(status, options));
  bucket.store.reset(store);
  jsStreamInfo* about = nullptr;
  status = js_GetStreamInfo(&about, stream, ("KV_" + options.bucket).c_str(), nullptr, nullptr);
  if (status != NATS_OK) return tl::make_unexpected(without_store(status, options));
  bucket.made_ns = about->Created;
  jsStreamInfo_Destroy(about);
  return bucket;
}

Result<NatsBucket> open_nats_bucket(natsConnection* connection, const NatsOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  for (;;) {
    auto bucket = try_nats_bucket(connection, options);
    if (bucket) return bucket;
    if (const auto refused = refusal(connection, options)) return tl::make_unexpected(*refused);
    if (std::chrono::steady_clock::now() - begin > kStart) return bucket;
    std::this_thread::sleep_for(kBucketRetry);
  }
}

}  // namespace dance
