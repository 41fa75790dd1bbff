#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/program/figures.h"
#include "research/codec/codec_room.h"

namespace dance {

std::string codec_room_table(const CodecRoom& r, const CodecRoomOptions& options) {
  std::string out = fmt::format(
      "\n  a room of {} at {:.0f} a second, {:.0f} ms there and back, each line loses {:g} % in "
      "each direction\n",
      r.guests, r.hz, options.round_trip.as_ms(), options.loss * 100.0);
  out += fmt::format(
      "  down, a guest     {:>12.1f} kB/s in {:.0f} datagrams a second; raw floats {:.1f} kB/s\n",
      r.down_bytes_per_s / 1e3, r.down_datagrams_per_s, r.raw_bytes_per_s / 1e3);
  out += fmt::format("  up, a guest       {:>12.1f} kB/s in {:.0f} datagrams a second\n",
                     r.up_bytes_per_s / 1e3, r.up_datagrams_per_s);
  const CodecRoomCosts& c = r.down_costs;
  out += fmt::format(
      "  of down           {:>12.1f} payloads, {:.1f} records' heads, {:.1f} IP and UDP, {:.1f} "
      "headers, {:.1f} "
      "feedback, {:.1f} ages, {:.1f} rest\n",
      c.payloads / 1e3, c.record_heads / 1e3, c.ip_udp / 1e3, c.headers / 1e3, c.feedback / 1e3,
      c.ages / 1e3, c.rest / 1e3);
  out += fmt::format(
      "  poses             {:>12.1f} bytes each, {:.3f} % of those received decoded, {:.2f} % "
      "arrived after {:.1f} "
      "ms; references: {}, what all have is {:.1f} frames old\n",
      r.payload_bytes, 100.0 * r.decoded_fraction, 100.0 * r.arrived_fraction, r.delay_ms, r.policy,
      r.acked_age_frames);
  return out;
}

std::string codec_room_json(const CodecRoom& r, const CodecRoomOptions& options) {
  const CodecRoomCosts& c = r.down_costs;
  const nlohmann::ordered_json room{
      {"guests", r.guests},
      {"hz", r.hz},
      {"seconds", options.measured.as_seconds()},
      {"round_trip_ms", options.round_trip.as_ms()},
      {"loss_percent_each_line_and_direction", options.loss * 100.0},
      {"bytes_per_second_down_per_guest", std::round(r.down_bytes_per_s)},
      {"bytes_per_second_up_per_guest", std::round(r.up_bytes_per_s)},
      {"raw_bytes_per_second_down_per_guest", std::round(r.raw_bytes_per_s)},
      {"datagrams_per_second_down_per_guest", rounded(r.down_datagrams_per_s, 10.0)},
      {"datagrams_per_second_up_per_guest", rounded(r.up_datagrams_per_s, 10.0)},
      {"down_bytes_per_second",
       {{"payloads", std::round(c.payloads)},
        {"record_heads", std::round(c.record_heads)},
        {"ip_udp", std::round(c.ip_udp)},
        {"headers", std::round(c.headers)},
        {"feedback", std::round(c.feedback)},
        {"ages", std::round(c.ages)},
        {"rest", std::round(c.rest)}}},
      {"payload_bytes_mean", rounded(r.payload_bytes, 100.0)},
      {"wide_record_fraction", rounded(r.wide_records, 1e4)},
      {"decoded_fraction", rounded(r.decoded_fraction, 1e6)},
      {"arrived_fraction", rounded(r.arrived_fraction, 1e5)},
      {"acked_age_frames_mean", rounded(r.acked_age_frames, 100.0)},
      {"delay_ms_mean", rounded(r.delay_ms, 100.0)},
      {"reference_missing", r.reference_missing},
      {"malformed", r.malformed},
      {"policy", r.policy},
      {"path_loss", rounded(r.path_loss, 1e4)},
      {"path_round_trip_ms", rounded(r.path_round_trip.as_ms(), 10.0)}};
  return room.dump();
}

}  // namespace dance
