// Where the NATS client library was not there to build with.
#include "tunnel/nats/nats_bus.h"

namespace dance {

bool NatsBus::is_built() { return false; }

Result<std::unique_ptr<NatsBus>> NatsBus::connect(const NatsOptions&, Poller&) {
  return fail(
      "--cluster: this server was built without NATS: apt-get install libnats-dev, and build it "
      "again");
}

}  // namespace dance
