// The table of consumers for `dance listen --to`: a new one is one row.
//
// Ownership: the caller owns the consumer; the output must outlive it.
// Threads:   constants only.
// Failure:   make_consumer() of an unknown name lists the known ones.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "consumers/output_file.h"
#include "consumers/pose_consumer.h"

namespace dance {

struct ConsumerOptions {
  double hz = 0.0;  // lines, rows or frames a second of each guest; 0 = the consumer's own choice
  GuestId guest;    // not set: all; the first for a format of one guest
  std::uint64_t own_clock_id = 0;
};

std::vector<std::string> consumer_names();
Result<std::unique_ptr<PoseConsumer>> make_consumer(const std::string& name, OutputFile& output,
                                                    const ConsumerOptions& options);

}  // namespace dance
