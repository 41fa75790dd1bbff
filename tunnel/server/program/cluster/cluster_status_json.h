// The member "cluster" of a server's status, as JSON.
//
// Units/frames: as the names of its members say.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      what is not known is null.
#pragma once

#include "tunnel/server/program/cluster/cluster_status.h"
#include "tunnel/server/program/json_text.h"

namespace dance {

void add_json(const ClusterStatus& cluster, StatusJsonText& json);

}  // namespace dance
