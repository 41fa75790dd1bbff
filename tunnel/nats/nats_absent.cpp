// Where the NATS client library was not there to build with.
#include "tunnel/nats/nats_bus.h"
#include "tunnel/nats/nats_probe.h"
#include "tunnel/nats/values/nats_store.h"

namespace dance {
namespace {

constexpr const char* kAbsent =
    "--cluster: this program was built without NATS: apt-get install libnats-dev, and build it "
    "again";

}  // namespace

bool NatsBus::is_built() { return false; }

Result<std::unique_ptr<NatsBus>> NatsBus::connect(const NatsOptions&, Poller&) {
  return fail(kAbsent);
}

Result<std::unique_ptr<NatsStore>> NatsStore::connect(const NatsOptions&) { return fail(kAbsent); }

NatsProbe probe_nats(const NatsOptions&, const std::vector<std::string>&) {
  NatsProbe found;
  found.no_connection = Error{kAbsent};
  return found;
}

}  // namespace dance
