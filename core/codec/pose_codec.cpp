#include "core/codec/pose_codec.h"

#include <algorithm>
#include <array>

#include "core/codec/plain_codec.h"

namespace dance {
namespace {

constexpr std::array kKnown{CodecId::kPlain};

}  // namespace

std::span<const CodecId> known_codecs() { return kKnown; }

bool is_known(CodecId id) { return std::find(kKnown.begin(), kKnown.end(), id) != kKnown.end(); }

std::unique_ptr<PoseEncoder> make_pose_encoder(CodecId id) {
  if (id == CodecId::kPlain) return std::make_unique<PlainEncoder>();
  return nullptr;
}

std::unique_ptr<PoseDecoder> make_pose_decoder(CodecId id) {
  if (id == CodecId::kPlain) return std::make_unique<PlainDecoder>();
  return nullptr;
}

}  // namespace dance
