// Checks of a cluster: NATS, what it lets this user do, and the servers that beat there.
//
// Ownership: plain values.
// Threads:   call from main; waits some seconds.
// Failure:   a check that cannot look says so in its finding.
#pragma once

#include <map>
#include <vector>

#include "apps/doctor/doctor_checks.h"
#include "tunnel/cluster/cluster_probe.h"
#include "tunnel/nats/nats_probe.h"

namespace dance {

// Pure, so that they can be tested: from what NATS said to who asked with these options,
std::vector<Finding> check_nats(const NatsProbe& found, const NatsOptions& options);
// and from the servers that were heard.
std::vector<Finding> check_servers(const std::map<ServerId, ClusterProbe::Seen>& seen);

std::vector<Finding> examine_cluster(const NatsOptions& options);

}  // namespace dance
