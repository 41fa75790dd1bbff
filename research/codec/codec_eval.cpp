#include "research/codec/codec_eval.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "core/codec/lattice/lattice_codec.h"
#include "core/codec/lossless/lossless_codec.h"
#include "research/codec/codec_loss.h"

namespace dance {
namespace {

using Payload = std::array<std::uint8_t, kMaxPosePayload>;

double now_ns() {
  return static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                 std::chrono::steady_clock::now().time_since_epoch())
                                 .count());
}

struct Errors {
  CodecErrors worst;
  double sum_m = 0.0;
  std::size_t count = 0;
  void add(const BodyLattice& lattice, const Pose& given, const Pose& got) {
    // As a receiver sees it: floats, through the same kinematics.
    LatticeBodyState seen;
    const TrueBody body = true_body(lattice, got);
    seen.joint = body.joint;
    seen.global = body.global;
    const BodyError e = error_of(lattice, true_body(lattice, given), seen);
    worst.max_position_m = std::max(worst.max_position_m, e.joint_m);
    worst.max_angle_rad = std::max(worst.max_angle_rad, e.angle_rad);
    sum_m += e.mean_joint_m;
    ++count;
  }
  CodecErrors result() const {
    CodecErrors errors = worst;
    if (count > 0) errors.mean_position_m = sum_m / static_cast<double>(count);
    return errors;
  }
};

AgeResult measure_age(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                      std::uint32_t age, Errors& errors, std::size_t& refused) {
  std::vector<double> sizes;
  double encode_ns = 0.0, decode_ns = 0.0;
  for (const CodecTake& take : takes) {
    LatticeEncoder encoder(options.model);
    LatticeDecoder decoder(options.model);
    const BodyLattice lattice(take.skeleton, options.model->rest);
    encoder.set_skeleton(take.skeleton);
    decoder.set_skeleton(take.skeleton);
    encoder.set_quality(options.error_m);
    encoder.refer_to_age(age);
    Payload payload{};
    for (const Pose& pose : take.poses) {
      if (age == 0) encoder.request_intra();
      const double begin = now_ns();
      const std::size_t size = encoder.encode(pose, payload);
      const double between = now_ns();
      if (size == 0) {
        ++refused;
        continue;
      }
      Pose decoded;
      const DecodeResult result = decoder.decode(pose.sequence, {payload.data(), size}, decoded);
      decode_ns += now_ns() - between;
      encode_ns += between - begin;
      DANCE_ASSERT(result == DecodeResult::kPose, pose.sequence);
      errors.add(lattice, pose, decoded);
      // Until four frames stand before the reference there is less to go by.
      if (pose.sequence >= age + 3) sizes.push_back(static_cast<double>(size));
    }
  }
  AgeResult result;
  result.age = age == 0 ? "intra" : std::to_string(age);
  const auto count = static_cast<double>(sizes.size());
  for (const double size : sizes) result.mean_bytes += size / count;
  std::sort(sizes.begin(), sizes.end());
  if (!sizes.empty()) result.p99_bytes = sizes[static_cast<std::size_t>(0.99 * (count - 1.0))];
  result.encode_ns = encode_ns / count;
  result.decode_ns = decode_ns / count;
  return result;
}

// Three components of the quaternion as 16-bit numbers, w from the unit norm: what the original
// DanceGraph sends of a bone.
void measure_three_int16(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                         CodecEval& out) {
  Errors errors;
  for (const CodecTake& take : takes) {
    const BodyLattice lattice(take.skeleton, options.model->rest);
    for (const Pose& pose : take.poses) {
      Pose got = pose;
      for (auto& q : got.R_PB) {
        const double sign = q.w() < 0.0f ? -1.0 : 1.0;
        Eigen::Vector3d v = sign * q.vec().cast<double>();
        for (int i = 0; i < 3; ++i) v[i] = std::trunc(v[i] * 32767.0) / 32767.0;
        const double w = std::sqrt(std::max(0.0, 1.0 - v.squaredNorm()));
        q = Eigen::Quaterniond(w, v.x(), v.y(), v.z()).normalized().cast<float>();
      }
      errors.add(lattice, pose, got);
    }
  }
  out.three_int16_bytes = kBoneCount * 6 + 12;
  out.three_int16_errors = errors.result();
}

double measure_lossless(const std::vector<CodecTake>& takes) {
  double bytes = 0.0, frames = 0.0;
  std::array<std::uint8_t, kMaxLosslessPayload> payload{};
  for (const CodecTake& take : takes) {
    LosslessEncoder encoder;
    LosslessDecoder decoder;
    for (const Pose& pose : take.poses) {
      const std::size_t size = encoder.encode(pose, payload);
      Pose got;
      const DecodeResult result = decoder.decode({payload.data(), size}, got);
      DANCE_ASSERT(result == DecodeResult::kPose && got.R_PB[0].coeffs() == pose.R_PB[0].coeffs(),
                   pose.sequence);
      bytes += static_cast<double>(size);
      frames += 1.0;
    }
  }
  return bytes / frames;
}

std::size_t count_moving(const std::vector<CodecTake>& takes) {
  std::uint32_t moving = 0;
  for (const CodecTake& take : takes)
    for (const Pose& pose : take.poses)
      for (std::size_t b = 0; b < kBoneCount; ++b)
        if (std::abs(pose.R_PB[b].dot(take.poses[0].R_PB[b])) < 0.999999f) moving |= 1u << b;
  return static_cast<std::size_t>(std::popcount(moving));
}

}  // namespace

CodecEval evaluate_codec(const std::vector<CodecTake>& takes, const CodecEvalOptions& options) {
  CodecEval eval;
  for (const CodecTake& take : takes) eval.frames += take.poses.size();
  eval.hz = takes.front().hz;
  eval.moving_joints = count_moving(takes);
  Errors errors;
  for (const std::uint32_t age : {1u, 2u, 4u, 8u, 0u})
    eval.ages.push_back(measure_age(takes, options, age, errors, eval.refused));
  eval.errors = errors.result();
  measure_three_int16(takes, options, eval);
  eval.lossless_bytes = measure_lossless(takes);
  if (options.loss_percent)
    for (const References policy :
         {References::kPrevious, References::kPreviousTwice, References::kAcknowledged})
      eval.losses.push_back(send_over_line(takes, options, policy));
  if (options.room_guests > 0) eval.room = dance_in_room(takes, room_options(options));
  return eval;
}

double mean_bytes_of(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                     std::uint32_t age) {
  Errors errors;
  std::size_t refused = 0;
  return measure_age(takes, options, age, errors, refused).mean_bytes;
}

CodecRoomOptions room_options(const CodecEvalOptions& options) {
  CodecRoomOptions room;
  room.guests = options.room_guests;
  room.loss = options.loss_percent.value_or(0.0) / 100.0;
  room.round_trip = options.round_trip;
  room.measured = options.room_time;
  room.error_m = options.error_m;
  room.model = options.model;
  return room;
}

}  // namespace dance
