// A room of many dancers, measured: the tunnel's own server and links in simulated time, over lines
// that delay and lose, each dancer with a take of her own.
//
// Units/frames: bytes a second with the 28 bytes of IP and UDP of each datagram, of what is sent on
//               a line, lost or not; round_trip is from a dancer to another and back, over four
//               lines; loss is that of each house's line, in each direction, so that a pose passes
//               two that lose.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "core/codec/lattice/pose_model.h"
#include "research/codec_takes.h"

namespace dance {

struct CodecRoomOptions {
  std::size_t guests = 30;
  double loss = 0.0;  // part
  Duration round_trip = Duration::ms(67);
  Duration warm_up = Duration::s(4);
  Duration measured = Duration::s(8);
  double error_m = 0.001;
  std::shared_ptr<const PoseModel> model;
};

// What the server sends to one guest in a second, by what it is for.
struct CodecRoomCosts {
  double ip_udp = 0.0;
  double headers = 0.0;   // session, type, number, acknowledgements, time
  double feedback = 0.0;  // about what the others have
  double record_heads = 0.0;
  double ages = 0.0;  // of the hops
  double payloads = 0.0;
  double rest = 0.0;  // pongs, rosters, proportions
};

struct CodecRoom {
  std::size_t guests = 0;
  double hz = 0.0;
  double down_bytes_per_s = 0.0;  // of one guest
  double up_bytes_per_s = 0.0;
  double down_datagrams_per_s = 0.0;
  double up_datagrams_per_s = 0.0;
  CodecRoomCosts down_costs;
  double payload_bytes = 0.0;     // mean of what came down
  double wide_records = 0.0;      // part of them
  double decoded_fraction = 0.0;  // of the poses that came
  double arrived_fraction = 0.0;  // of those sent to others
  double acked_age_frames = 0.0;  // mean age of the newest pose that all have, as the next is made
  double delay_ms = 0.0;          // mean, from the link to the other link's handler
  std::size_t reference_missing = 0;
  std::size_t malformed = 0;
  std::string policy;  // of most
  double path_loss = 0.0;
  Duration path_round_trip;
  double raw_bytes_per_s = 0.0;  // down: floats, a datagram each
};

CodecRoom dance_in_room(const std::vector<CodecTake>& takes, const CodecRoomOptions& options);
// As dance codec eval prints it.
std::string codec_room_table(const CodecRoom& room, const CodecRoomOptions& options);
// As it stands in its JSON under "room".
std::string codec_room_json(const CodecRoom& room, const CodecRoomOptions& options);

}  // namespace dance
