#include "core/codec/pose_codec.h"

#include <algorithm>
#include <array>

#include "core/codec/lattice/lattice_codec.h"
#include "core/codec/plain_codec.h"

namespace dance {

const char* name_of(References references) {
  switch (references) {
    case References::kPrevious:
      return "previous";
    case References::kPreviousTwice:
      return "previous twice";
    case References::kAcknowledged:
      return "acknowledged";
  }
  return "";
}

std::span<const CodecName> known_codecs() {
  static const std::array kKnown{CodecName{CodecId::kLattice, built_in_model()->name},
                                 CodecName{CodecId::kLattice, generic_model()->name},
                                 CodecName{CodecId::kPlain, 0}};
  return kKnown;
}

bool is_known(CodecName name) {
  const auto known = known_codecs();
  return std::find(known.begin(), known.end(), name) != known.end();
}

std::unique_ptr<PoseEncoder> make_pose_encoder(CodecName name) {
  if (!is_known(name)) return nullptr;
  if (name.id == CodecId::kPlain) return std::make_unique<PlainEncoder>();
  return std::make_unique<LatticeEncoder>(name.model == 0 ? generic_model() : built_in_model());
}

std::unique_ptr<PoseDecoder> make_pose_decoder(CodecName name) {
  if (!is_known(name)) return nullptr;
  if (name.id == CodecId::kPlain) return std::make_unique<PlainDecoder>();
  return std::make_unique<LatticeDecoder>(name.model == 0 ? generic_model() : built_in_model());
}

}  // namespace dance
