// The table of receivers for `dance receive --from` and `[[produce]]` of a session: a new one is
// one row.
//
// Units/frames: none.
// Ownership:    the caller owns the receiver; sink and poller must outlive it.
// Threads:      constants only; a receiver runs in the poller's thread.
// Failure:      open_receiver() of an unknown name lists the known ones; a port that is taken is
//               named with the cure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/net/poller.h"
#include "producers/capture_sink.h"
#include "producers/receive/pose_receiver.h"

namespace dance {

// Where a receiver hears its program or device.
enum class InputKind : std::uint8_t {
  kAddress,  // datagrams at an address of this machine
  kMemory,   // an engine on this machine, by a name
};

struct ReceiverOptions {
  GuestId guest;
  std::string listen;  // address:port to hear at; "" = the protocol's port on this machine only
  std::string name;    // of an engine; "" = its usual name
  std::string actor;   // whom of several in one stream, by the sender's name; "" = the first
};

struct ReceiverKind {
  std::string name;
  InputKind input = InputKind::kAddress;
  std::string usual_input;  // its address or name where none is given
  bool has_actors = false;
};

std::vector<std::string> receiver_names();
// nullptr for an unknown name.
const ReceiverKind* find_receiver_kind(const std::string& name);
// What is wrong with the options for this kind: an address for an engine, …
Result<void> check_receiver_options(const ReceiverKind& kind, const ReceiverOptions& options);
Result<std::unique_ptr<PoseReceiver>> open_receiver(const std::string& from,
                                                    const ReceiverOptions& options,
                                                    CaptureSink& sink, Poller& poller);

}  // namespace dance
