// A page of metrics for Prometheus, at http://ADDRESS/metrics. docs/server.md lists them.
//
// Units/frames: seconds, bytes, ratios from 0 to 1, as their names say.
// Ownership:    keeps the newest snapshot that was shown, until the last reader is done with it.
// Threads:      show() from the server's thread: it swaps a pointer under a mutex that is never
//               held for longer than that. The page is made in threads of the exposer's own.
// Failure:      open() says which address cannot be had; where not is_built(), none can.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/net/address.h"
#include "tunnel/server/program/server_status.h"

namespace dance {

constexpr std::uint16_t kDefaultMetricsPort = 9464;

class ServerMetrics {
 public:
  static bool is_built();
  static Result<std::unique_ptr<ServerMetrics>> open(const Address& address);
  virtual ~ServerMetrics() = default;

  virtual void show(ServerStatus status) = 0;
  virtual std::uint16_t port() const = 0;
};

// The page of a snapshot; empty in a build without Prometheus.
std::string metrics_text(const ServerStatus& status);

}  // namespace dance
