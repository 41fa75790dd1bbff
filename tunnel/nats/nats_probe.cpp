#include "tunnel/nats/nats_probe.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/base/printable.h"
#include "tunnel/nats/nats_connection.h"

namespace dance {
namespace {

constexpr int kRoundTrips = 20;
constexpr std::int64_t kExaminationAnswer_ms = 2000;
// No revision that a bucket ever has: so nothing is written, and whether it may be is known.
constexpr std::uint64_t kNeverARevision = std::uint64_t{1} << 60;
constexpr const char* kNeverAKey = "doctor";

Error said_by(natsConnection* connection, natsStatus status) {
  const char* said = nullptr;
  if (natsConnection_GetLastError(connection, &said) == NATS_NOT_PERMITTED && said != nullptr)
    return Error{printable(said)};
  said = status == NATS_TIMEOUT ? nullptr : nats_GetLastError(nullptr);
  return Error{std::string(natsStatus_GetText(status)) +
               (said != nullptr ? ": " + printable(said) : std::string())};
}

void probe_replicas(jsCtx* stream, NatsProbe::Bucket& bucket) {
  jsStreamInfo* info = nullptr;
  if (js_GetStreamInfo(&info, stream, ("KV_" + bucket.name).c_str(), nullptr, nullptr) != NATS_OK)
    return;
  bucket.replicas = static_cast<int>(info->Config->Replicas);
  bucket.current_replicas = 1;
  for (int i = 0; info->Cluster != nullptr && i < info->Cluster->ReplicasLen; ++i)
    if (info->Cluster->Replicas[i]->Current && !info->Cluster->Replicas[i]->Offline)
      ++bucket.current_replicas;
  jsStreamInfo_Destroy(info);
}

NatsProbe::Bucket probe_bucket(natsConnection* connection, jsCtx* stream, const std::string& name) {
  NatsProbe::Bucket bucket;
  bucket.name = name;
  kvStore* opened = nullptr;
  natsStatus status = js_KeyValue(&opened, stream, name.c_str());
  if (status != NATS_OK) {
    if (status != NATS_NOT_FOUND) bucket.cannot_read = said_by(connection, status);
    return bucket;
  }
  const NatsHandle<kvStore> store(opened);
  bucket.is_there = true;
  probe_replicas(stream, bucket);
  kvEntry* entry = nullptr;
  status = kvStore_Get(&entry, opened, kNeverAKey);
  if (status == NATS_OK)
    kvEntry_Destroy(entry);
  else if (status != NATS_NOT_FOUND)
    bucket.cannot_read = said_by(connection, status);
  std::uint64_t revision = 0;
  status = kvStore_Update(&revision, opened, kNeverAKey, "", 0, kNeverARevision);
  const char* said = nats_GetLastError(nullptr);
  const bool is_revision_wrong = status != NATS_TIMEOUT && said != nullptr &&
                                 std::strstr(said, "wrong last sequence") != nullptr;
  if (status != NATS_OK && !is_revision_wrong) bucket.cannot_write = said_by(connection, status);
  return bucket;
}

}  // namespace

NatsProbe probe_nats(const NatsOptions& options, const std::vector<std::string>& buckets) {
  NatsProbe found;
  auto connected = connect_nats(options, {});
  if (!connected) {
    found.no_connection = connected.error();
    return found;
  }
  natsConnection* connection = connected->get();
  std::array<char, 256> url{};
  natsConnection_GetConnectedUrl(connection, url.data(), url.size());
  NatsOptions shown;
  shown.urls = {url.data()};
  found.server = shown_urls(shown);
  std::int64_t shortest_ns = INT64_MAX;
  for (int i = 0; i < kRoundTrips; ++i) {
    std::int64_t round_trip_ns = 0;
    if (natsConnection_GetRTT(connection, &round_trip_ns) == NATS_OK)
      shortest_ns = std::min(shortest_ns, round_trip_ns);
  }
  if (shortest_ns != INT64_MAX) found.round_trip = Duration::ns(shortest_ns);
  jsOptions wait;
  jsOptions_Init(&wait);
  wait.Wait = kExaminationAnswer_ms;
  jsCtx* made = nullptr;
  natsStatus status = natsConnection_JetStream(&made, connection, &wait);
  const NatsHandle<jsCtx> stream(made);
  jsAccountInfo* account = nullptr;
  if (status == NATS_OK) status = js_GetAccountInfo(&account, made, nullptr, nullptr);
  if (status != NATS_OK) {
    found.no_jetstream = said_by(connection, status);
    return found;
  }
  jsAccountInfo_Destroy(account);
  for (const std::string& name : buckets)
    found.buckets.push_back(probe_bucket(connection, made, name));
  return found;
}

}  // namespace dance
