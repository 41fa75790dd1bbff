// The options of programs that connect to a cluster. Passwords come from files that only their
// owner can read: all users of a machine can read command lines.
//
// Failure: nats_options_of() names the option that is wrong, and the cure.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/program/program.h"
#include "tunnel/nats/nats_options.h"

namespace dance {

struct ClusterOptions {
  std::string urls;   // as nats_urls(); "" = no cluster
  std::string login;  // file of USER:PASSWORD or of a token; "" = none
  NatsOptions nats;
  std::string address;     // HOST[:PORT] as guests reach this server
  std::uint16_t port = 0;  // of this server
};
// Puts the URLs into the options, with the login of its file. Refuses a login on the command line,
// and files of secrets that others may read.
Result<NatsOptions> nats_options_of(const ClusterOptions& options);
// --cluster, and how NATS knows us.
void add_cluster_options(CommandLine& line, ClusterOptions& options, const std::string& what);

}  // namespace dance
