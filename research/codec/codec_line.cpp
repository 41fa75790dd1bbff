#include "research/codec/codec_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "core/base/random.h"
#include "core/codec/lattice_codec.h"

namespace dance {
namespace {

// What comes back after a round trip.
struct Answer {
  std::size_t at_frame = 0;
  std::uint32_t sequence = 0;
  bool is_decoded = false;
};

}  // namespace

LossResult send_over_line(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                          References policy) {
  LossResult result;
  result.policy = name_of(policy);
  const double loss = options.loss_percent.value_or(0.0) / 100.0;
  double sent = 0.0, bytes = 0.0, received = 0.0, decoded = 0.0, keys = 0.0;
  Random random(7);
  for (const CodecTake& take : takes) {
    LatticeEncoder encoder(options.model);
    LatticeDecoder decoder(options.model);
    encoder.set_skeleton(take.skeleton);
    decoder.set_skeleton(take.skeleton);
    encoder.set_quality(options.error_m);
    encoder.set_references(policy);
    const auto trip = static_cast<std::size_t>(
        std::max(1.0, std::ceil(options.round_trip.as_seconds() * take.hz - 1e-6)));
    std::deque<Answer> answers;
    std::size_t asked_at = 0;
    double gap = 0.0;
    std::array<std::uint8_t, kMaxPosePayload> payload{};
    for (std::size_t i = 0; i < take.poses.size(); ++i) {
      for (; !answers.empty() && answers.front().at_frame <= i; answers.pop_front()) {
        if (answers.front().is_decoded) {
          encoder.acknowledged(answers.front().sequence);
        } else if (i >= asked_at) {
          // One request a round trip.
          encoder.key_frame_wanted();
          asked_at = i + trip;
          keys += 1.0;
        }
      }
      const Pose& pose = take.poses[i];
      const std::size_t size = encoder.encode(pose, payload);
      sent += 1.0;
      bytes += static_cast<double>(size);
      if (random.uniform() < loss) continue;
      received += 1.0;
      Pose got;
      const bool is_decoded =
          decoder.decode(pose.sequence, {payload.data(), size}, got) == DecodeResult::kPose;
      decoded += is_decoded ? 1.0 : 0.0;
      gap = is_decoded ? 0.0 : gap + 1.0;
      result.longest_gap_frames = std::max(result.longest_gap_frames, gap);
      // The way back loses too.
      if (random.uniform() < loss) continue;
      answers.push_back({i + trip, pose.sequence, is_decoded});
    }
  }
  result.wire_bytes = bytes / sent;
  result.decoded_fraction = decoded / received;
  result.key_frames = keys / sent;
  return result;
}

}  // namespace dance
