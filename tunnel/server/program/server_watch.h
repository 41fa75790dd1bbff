// What shows a running server to people and programs: the socket of `dance status`, the page of
// metrics, and the service manager that started it.
//
// Units/frames: MonoTime of the poller's clock; of the core its own.
// Ownership:    refers to the core and the poller, which must outlive it.
// Threads:      the poller's; the metrics' exposer has threads of its own, which see snapshots
//               only.
// Failure:      open() fails where metrics were asked for and cannot be had. Without a socket for
//               `dance status` the server runs on, and says so.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/net/local_socket.h"
#include "core/net/poller.h"
#include "core/net/service_manager.h"
#include "tunnel/server/program/server_metrics.h"
#include "tunnel/server/program/server_status.h"

namespace dance {

// The file name of a server's socket in local_socket_folder().
std::string status_socket_name(std::uint16_t port);

class ServerWatch {
 public:
  struct Options {
    Address address;      // where the server hears
    ServerLimits limits;  // of the core
    std::string metrics;  // HOST:PORT; "" = none
    ServerStatusMaker::PeerText peer_text;
    // By cause; not set = nobody seals.
    std::function<std::vector<NamedCount>()> handshakes;
    // Not set = there is none.
    std::function<ClusterStatus(MonoTime now)> cluster;
    // The clock of the core; not set = the poller's.
    std::function<MonoTime(MonoTime)> to_session;
  };

  static Result<std::unique_ptr<ServerWatch>> open(const ServerCore& core, const Options& options,
                                                   Poller& poller);
  ~ServerWatch();
  ServerWatch(const ServerWatch&) = delete;
  ServerWatch& operator=(const ServerWatch&) = delete;

  void say_stopping() { service_.say_stopping(); }

 private:
  ServerWatch(const ServerCore& core, const Options& options, Poller& poller);
  ServerStatus status(MonoTime now) const;
  MonoTime session_time(MonoTime now) const { return to_session_ ? to_session_(now) : now; }

  Poller& poller_;
  std::function<std::vector<NamedCount>()> handshakes_;
  std::function<ClusterStatus(MonoTime)> cluster_;
  std::function<MonoTime(MonoTime)> to_session_;
  ServerStatusMaker maker_;
  ServiceManager service_;
  std::unique_ptr<ServerMetrics> metrics_;
  std::unique_ptr<LocalTextServer> socket_;
  Poller::TimerId second_;
  Poller::TimerId alive_;
};

}  // namespace dance
