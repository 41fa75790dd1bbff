// The options of programs that speak with a cluster.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      nats_options_of() says which option is wrong.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/program/program.h"
#include "tunnel/nats/nats_options.h"

namespace dance {

struct ClusterOptions {
  std::string urls;  // as nats_urls(); "" = no cluster
  NatsOptions nats;
  std::string address;     // HOST[:PORT] as guests reach this server
  std::uint16_t port = 0;  // of this server
};
// With the URLs in them.
Result<NatsOptions> nats_options_of(const ClusterOptions& options);
// --cluster, and how NATS knows us.
void add_cluster_options(CommandLine& line, ClusterOptions& options, const std::string& what);

}  // namespace dance
