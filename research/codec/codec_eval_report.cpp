#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/codec/lossless/lossless_codec.h"
#include "core/program/figures.h"
#include "research/codec/codec_eval.h"

namespace dance {
namespace {

double degrees(double rad) { return rad * 180.0 / 3.14159265358979323846; }

// The policy that the tunnel would choose: docs/codec.md.
const LossResult& best_of(const std::vector<LossResult>& losses) {
  const LossResult* best = &losses.back();
  for (const LossResult& loss : losses)
    if (loss.decoded_fraction >= 0.995 && loss.wire_bytes < best->wire_bytes) best = &loss;
  return *best;
}

}  // namespace

std::string codec_eval_table(const CodecEval& r, const CodecEvalOptions& options) {
  const double raw = kRawPose_bytes;
  std::string out = fmt::format(
      "{} frames at {:.0f} a second, {} of 22 bones move; every joint and tip within {:g} mm\n\n",
      r.frames, r.hz, r.moving_joints, options.error_m * 1e3);
  out += "  reference         bytes a frame     p99   of raw     encode     decode\n";
  for (const AgeResult& age : r.ages)
    out += fmt::format("  {:<17} {:>12.1f} {:>8.0f} {:>7.1f}% {:>8.1f} us {:>7.1f} us\n",
                       age.age == "intra" ? "intra frame"
                       : age.age == "1"   ? "1 frame old"
                                          : age.age + " frames old",
                       age.mean_bytes, age.p99_bytes, 100.0 * age.mean_bytes / raw,
                       age.encode_ns / 1e3, age.decode_ns / 1e3);
  out += fmt::format("  {:<17} {:>12.1f} {:>16.1f}%\n", "lossless", r.lossless_bytes,
                     100.0 * r.lossless_bytes / raw);
  out += fmt::format("  {:<17} {:>12.1f} {:>16.1f}%\n", "3 x int16 a bone", r.three_int16_bytes,
                     100.0 * r.three_int16_bytes / raw);
  out += fmt::format("  {:<17} {:>12.1f}\n\n", "raw floats", raw);
  const auto errors = [&](const char* what, const CodecErrors& e) {
    out += fmt::format(
        "  {:<17} joints at most {:.3f} mm, mean {:.3f} mm; bones at most {:.2f} deg\n", what,
        e.max_position_m * 1e3, e.mean_position_m * 1e3, degrees(e.max_angle_rad));
  };
  errors("this codec", r.errors);
  errors("3 x int16 a bone", r.three_int16_errors);
  if (r.refused > 0) out += fmt::format("  {} frames were refused\n", r.refused);
  const std::string room = r.room ? codec_room_table(*r.room, room_options(options)) : "";
  if (r.losses.empty()) return out + room;
  out += fmt::format("\n  {:g} % lost, round trip {:.0f} ms\n", *options.loss_percent,
                     options.round_trip.as_seconds() * 1e3);
  out += "  references        bytes a frame   decoded of received   longest gap   intra frames\n";
  for (const LossResult& loss : r.losses)
    out += fmt::format("  {:<17} {:>12.1f} {:>20.2f}% {:>8.0f} frames {:>9.2f}%\n", loss.policy,
                       loss.wire_bytes, 100.0 * loss.decoded_fraction, loss.longest_gap_frames,
                       100.0 * loss.intra_frames);
  return out + room;
}

std::string codec_eval_json(const CodecEval& r, const CodecEvalOptions& options) {
  nlohmann::ordered_json report{{"frames", r.frames}, {"joints", r.moving_joints}, {"hz", r.hz}};
  nlohmann::ordered_json by_age;
  for (const AgeResult& age : r.ages) by_age[age.age] = rounded(age.mean_bytes, 100.0);
  const AgeResult& first = r.ages.front();
  report["bytes_per_frame_mean"] = rounded(first.mean_bytes, 100.0);
  report["bytes_per_frame_p99"] = first.p99_bytes;
  report["bytes_by_reference_age"] = by_age;
  report["lossless_bytes_per_frame"] = rounded(r.lossless_bytes, 100.0);
  report["raw_bytes_per_frame"] = kRawPose_bytes;
  report["three_int16_bytes_per_frame"] = r.three_int16_bytes;
  report["three_int16_max_position_error_mm"] =
      rounded(r.three_int16_errors.max_position_m * 1e3, 1e4);
  report["max_position_error_mm"] = rounded(r.errors.max_position_m * 1e3, 1e4);
  report["mean_position_error_mm"] = rounded(r.errors.mean_position_m * 1e3, 1e4);
  report["max_angle_error_deg"] = rounded(degrees(r.errors.max_angle_rad), 1e3);
  report["encode_ns"] = std::round(first.encode_ns);
  report["decode_ns"] = std::round(first.decode_ns);
  report["refused"] = r.refused;
  if (!r.losses.empty()) {
    const LossResult& best = best_of(r.losses);
    report["policy"] = best.policy;
    report["decoded_fraction"] = rounded(best.decoded_fraction, 1e5);
    report["wire_bytes_per_frame"] = rounded(best.wire_bytes, 100.0);
    for (const LossResult& loss : r.losses)
      report["policies"][loss.policy] = {{"decoded_fraction", rounded(loss.decoded_fraction, 1e5)},
                                         {"wire_bytes_per_frame", rounded(loss.wire_bytes, 100.0)},
                                         {"longest_gap_frames", loss.longest_gap_frames},
                                         {"key_frame_fraction", rounded(loss.intra_frames, 1e4)}};
  }
  if (r.room)
    report["room"] = nlohmann::ordered_json::parse(codec_room_json(*r.room, room_options(options)));
  return report.dump(2) + "\n";
}

}  // namespace dance
