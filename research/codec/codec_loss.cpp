#include "research/codec/codec_loss.h"

#include <algorithm>
#include <array>
#include <deque>

#include "core/codec/lattice/lattice_codec.h"
#include "testing/line/lossy_model.h"

namespace dance {
namespace {

// What comes back after a round trip.
struct Answer {
  MonoTime at;
  std::uint32_t sequence = 0;
  bool is_decoded = false;
};

}  // namespace

LossResult send_over_line(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                          References policy) {
  LossResult result;
  result.policy = name_of(policy);
  double sent = 0.0, bytes = 0.0, received = 0.0, decoded = 0.0, keys = 0.0;
  // Both directions take turns on one line, which loses in each; its delay is the round trip.
  LossySpec spec;
  spec.delay = options.round_trip;
  spec.loss = options.loss_percent.value_or(0.0) / 100.0;
  spec.seed = 0;
  LossyModel line({.spec = spec}, 7);
  MonoTime begin = MonoTime::from_us(1'000'000);
  for (const CodecTake& take : takes) {
    LatticeEncoder encoder(options.model);
    LatticeDecoder decoder(options.model);
    encoder.set_skeleton(take.skeleton);
    decoder.set_skeleton(take.skeleton);
    encoder.set_quality(options.error_m);
    encoder.set_references(policy);
    std::deque<Answer> answers;
    MonoTime may_ask_from = begin;
    double gap = 0.0;
    std::array<std::uint8_t, kMaxPosePayload> payload{};
    for (std::size_t i = 0; i < take.poses.size(); ++i) {
      const MonoTime now = begin + Duration::seconds(static_cast<double>(i) / take.hz);
      for (; !answers.empty() && answers.front().at <= now; answers.pop_front()) {
        if (answers.front().is_decoded) {
          encoder.acknowledged(answers.front().sequence);
        } else if (now >= may_ask_from) {
          // One request a round trip.
          encoder.request_intra();
          may_ask_from = now + options.round_trip;
          keys += 1.0;
        }
      }
      const Pose& pose = take.poses[i];
      const std::size_t size = encoder.encode(pose, payload);
      sent += 1.0;
      bytes += static_cast<double>(size);
      if (line.offer(size, now).is_lost()) continue;
      received += 1.0;
      Pose got;
      const bool is_decoded =
          decoder.decode(pose.sequence, {payload.data(), size}, got) == DecodeResult::kPose;
      decoded += is_decoded ? 1.0 : 0.0;
      gap = is_decoded ? 0.0 : gap + 1.0;
      result.longest_gap_frames = std::max(result.longest_gap_frames, gap);
      const LossyModel::Fate answer = line.offer(size, now);
      for (const MonoTime at : answer.deliveries())
        answers.push_back({at, pose.sequence, is_decoded});
    }
    begin += Duration::seconds(static_cast<double>(take.poses.size()) / take.hz);
  }
  result.wire_bytes = bytes / sent;
  result.decoded_fraction = decoded / received;
  result.intra_frames = keys / sent;
  return result;
}

}  // namespace dance
