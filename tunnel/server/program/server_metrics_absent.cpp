// For builds without prometheus-cpp.
#include "tunnel/server/program/server_metrics.h"

namespace dance {

bool ServerMetrics::is_built() { return false; }

Result<std::unique_ptr<ServerMetrics>> ServerMetrics::open(const Address& address) {
  return fail("no metrics at " + address.to_string() + " in this build");
}

std::string metrics_text(const ServerStatus&) { return ""; }

}  // namespace dance
