#include "tunnel/server/program/cluster/cluster_options.h"

namespace dance {

Result<NatsOptions> nats_options_of(const ClusterOptions& options) {
  NatsOptions nats = options.nats;
  nats.urls = nats_urls(options.urls);
  if (nats.urls.empty()) return fail("--cluster names no NATS server: nats://HOST:4222");
  if (nats.certificate.empty() != nats.private_key.empty())
    return fail("--cluster-certificate and --cluster-private-key belong together");
  return nats;
}

void add_cluster_options(CommandLine& line, ClusterOptions& options, const std::string& what) {
  line.add("--cluster", options.urls, what);
  line.add("--cluster-credentials", options.nats.credentials,
           "file of the NATS user that this program is (.creds)");
  line.add("--cluster-authorities", options.nats.authorities,
           "PEM file of those whose signature the NATS servers' certificates bear (tls://)");
  line.add("--cluster-certificate", options.nats.certificate,
           "PEM file of this program's certificate, where NATS asks for one");
  line.add("--cluster-private-key", options.nats.private_key, "PEM file of its private key");
}

}  // namespace dance
