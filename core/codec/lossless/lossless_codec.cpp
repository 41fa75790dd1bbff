#include "core/codec/lossless/lossless_codec.h"

#include <bit>

#include "core/codec/coding/adaptive_bits.h"
#include "core/codec/lossless/lossless_model.h"

namespace dance {
namespace {

constexpr std::size_t kHeader_bytes = 2;
constexpr std::uint8_t kIntraFrame = 0x80;

}  // namespace

LosslessEncoder::LosslessEncoder() : model_(std::make_unique<LosslessModel>()) {}
LosslessEncoder::~LosslessEncoder() = default;
LosslessEncoder::LosslessEncoder(LosslessEncoder&&) noexcept = default;
LosslessEncoder& LosslessEncoder::operator=(LosslessEncoder&&) noexcept = default;

std::size_t LosslessEncoder::encode(const Pose& pose, std::span<std::uint8_t> out) {
  if (out.size() < kHeader_bytes) return 0;
  out[0] = model_->is_key() ? kIntraFrame : model_->counter();
  out[1] = model_->digest();
  LosslessFrame frame = lossless_frame(pose);
  BitEncoder coder(out.subspan(kHeader_bytes));
  model_->code(coder, frame);
  const std::size_t size = coder.finish();
  if (coder.ok()) return kHeader_bytes + size;
  model_->restart();
  return 0;
}

void LosslessEncoder::restart() { model_->restart(); }

LosslessDecoder::LosslessDecoder() : model_(std::make_unique<LosslessModel>()) {}
LosslessDecoder::~LosslessDecoder() = default;
LosslessDecoder::LosslessDecoder(LosslessDecoder&&) noexcept = default;
LosslessDecoder& LosslessDecoder::operator=(LosslessDecoder&&) noexcept = default;

DecodeResult LosslessDecoder::decode(std::span<const std::uint8_t> payload, Pose& pose) {
  if (payload.size() < kHeader_bytes || payload.size() > kMaxLosslessPayload)
    return DecodeResult::kMalformed;
  if ((payload[0] & kIntraFrame) != 0) {
    if (payload[0] != kIntraFrame || payload[1] != 0) return DecodeResult::kMalformed;
    model_->restart();
  } else if (model_->is_key() || payload[0] != model_->counter() ||
             payload[1] != model_->digest()) {
    return DecodeResult::kReferenceMissing;
  }
  LosslessFrame frame{};
  BitDecoder coder(payload.subspan(kHeader_bytes));
  model_->code(coder, frame);
  if (!coder.is_exhausted()) {
    model_->restart();
    return DecodeResult::kMalformed;
  }
  to_pose(frame, pose);
  return DecodeResult::kPose;
}

void LosslessDecoder::restart() { model_->restart(); }

LosslessGlance::LosslessGlance() : opening_(std::make_unique<LosslessOpening>()) {}
LosslessGlance::~LosslessGlance() = default;
LosslessGlance::LosslessGlance(LosslessGlance&&) noexcept = default;
LosslessGlance& LosslessGlance::operator=(LosslessGlance&&) noexcept = default;

DecodeResult LosslessGlance::look(std::span<const std::uint8_t> payload, Pose& pose) {
  if (payload.size() < kHeader_bytes || payload.size() > kMaxLosslessPayload)
    return DecodeResult::kMalformed;
  if (payload[0] == kIntraFrame) {
    opening_->restart();
    frames_ = 0;
  } else if (frames_ == 0 || payload[0] != (frames_ & 0x7f)) {
    return DecodeResult::kReferenceMissing;
  }
  BitDecoder coder(payload.subspan(kHeader_bytes));
  std::uint64_t music = 0;
  opening_->code(coder, pose.presence, music);
  pose.music_beats = std::bit_cast<double>(music);
  ++frames_;
  return DecodeResult::kPose;
}

}  // namespace dance
