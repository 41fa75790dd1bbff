// For builds without prometheus-cpp.
#include "tunnel/server_metrics.h"

namespace dance {

Result<std::unique_ptr<ServerMetrics>> ServerMetrics::open(const Address& address) {
  return fail("--metrics " + address.to_string() +
              ": this server was built without Prometheus: apt-get install prometheus-cpp-dev, "
              "and build it again");
}

std::string metrics_text(const ServerStatus&) { return ""; }

}  // namespace dance
