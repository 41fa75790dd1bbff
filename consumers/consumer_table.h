// The table of consumers for `dance listen --to` and `[[listen]]` of a session: a new one is one
// row.
//
// Units/frames: hz in frames a second of each guest.
// Ownership:    the caller owns the consumer, which owns its file or socket.
// Threads:      constants only.
// Failure:      make_consumer() of an unknown name lists the known ones; a file, an address or a
//               segment that cannot be had is named with the cure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "consumers/output_file.h"
#include "consumers/pose_consumer.h"

namespace dance {

// Where a consumer's output goes to.
enum class OutputKind : std::uint8_t {
  kFile,     // a file or standard output
  kAddress,  // datagrams to host:port
  kMemory,   // shared memory with a name
};

struct ConsumerOptions {
  double hz = 0.0;  // lines, rows or frames a second of each guest; 0 = the consumer's own choice
  GuestId guest;    // not set: all; the first for a format of one guest
  std::uint64_t own_clock_id = 0;
  std::string file;     // of a consumer of files; "" or "-" = standard output
  std::string address;  // of a consumer with an address; "" = the protocol's port on this machine
  std::string name;     // of a consumer of memory; "" = its usual name
  std::string dialect;  // of a protocol with several, a word that its row lists; "" = the first
};

struct ConsumerKind {
  std::string name;
  OutputKind output = OutputKind::kFile;
  std::string usual_output;  // its address or name where none is given
  std::vector<std::string> dialects;
};

std::vector<std::string> consumer_names();
// nullptr for an unknown name.
const ConsumerKind* find_consumer_kind(const std::string& name);
// What is wrong with the options for this kind: a file for a consumer with an address, a rate that
// none can be, …
Result<void> check_consumer_options(const ConsumerKind& kind, const ConsumerOptions& options);
Result<std::unique_ptr<PoseConsumer>> make_consumer(const std::string& name,
                                                    const ConsumerOptions& options);

}  // namespace dance
