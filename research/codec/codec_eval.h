// What the pose codec does with recorded dances: bytes by how old the reference is, errors, times,
// what a losing line leaves, and what a room costs, each beside what sending floats or three 16-bit
// numbers a bone takes.
//
// Units/frames: bytes of payload a frame; errors in W at joints and tips, bone rotations in W.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an Error says which option cannot be.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/codec/lattice/pose_model.h"
#include "research/codec/codec_room.h"
#include "research/codec_takes.h"

namespace dance {

struct CodecEvalOptions {
  double hz = 60.0;
  double jitter_deg = 0.0;
  double error_m = 0.001;
  std::shared_ptr<const PoseModel> model;
  std::optional<double> loss_percent;
  Duration round_trip = Duration::ms(67);
  std::size_t room_guests = 0;  // 0: no room
  Duration room_time = Duration::s(8);
};

struct CodecErrors {
  double max_position_m = 0.0;
  double mean_position_m = 0.0;
  double max_angle_rad = 0.0;
};

struct AgeResult {
  std::string age;  // "1", "2", "4", "8", "intra"
  double mean_bytes = 0.0;
  double p99_bytes = 0.0;
  double encode_ns = 0.0;
  double decode_ns = 0.0;
};

// A line that loses, under one policy of references.
struct LossResult {
  std::string policy;
  double wire_bytes = 0.0;          // a frame sent
  double decoded_fraction = 0.0;    // of those received
  double longest_gap_frames = 0.0;  // received but not decoded, in a row
  double intra_frames = 0.0;        // of those sent
};

struct CodecEval {
  std::size_t frames = 0;
  std::size_t moving_joints = 0;
  double hz = 0.0;
  std::vector<AgeResult> ages;
  CodecErrors errors;
  double three_int16_bytes = 0.0;
  CodecErrors three_int16_errors;
  double lossless_bytes = 0.0;
  std::size_t refused = 0;
  std::vector<LossResult> losses;
  std::optional<CodecRoom> room;
};

CodecRoomOptions room_options(const CodecEvalOptions& options);

CodecEval evaluate_codec(const std::vector<CodecTake>& takes, const CodecEvalOptions& options);
// Of frames that refer to one this many frames old; 0 = intra frames.
double mean_bytes_of(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                     std::uint32_t age);
std::string codec_eval_table(const CodecEval& result, const CodecEvalOptions& options);
std::string codec_eval_json(const CodecEval& result, const CodecEvalOptions& options);

}  // namespace dance
