// libFuzzer target: the first byte chooses the version, the rest is a packet of NatNet.
#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/base/assert.h"
#include "producers/natnet/natnet_body.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(natnet) {
  using namespace dance;
  static const auto frame = std::make_unique<NatNetFrame>();
  static const auto models = std::make_unique<NatNetModels>();
  static const auto body = std::make_unique<NatNetBody>();
  if (size == 0) return 0;
  constexpr NatNetVersion kVersions[] = {{3, 0}, {3, 1}, {4, 0}, {4, 1}};
  const NatNetVersion version = kVersions[data[0] % 4];
  const std::span<const std::uint8_t> packet(data + 1, size - 1);
  NatNetServer server;
  read_natnet_server(packet, server);
  if (read_natnet_models(packet, version, *models) == NatNetFault::kNone &&
      !models->skeletons.empty())
    body->set_rig(find_natnet_rig(models->skeletons[0]));
  if (read_natnet_frame(packet, version, *frame) != NatNetFault::kNone) return 0;
  for (const NatNetSkeleton& skeleton : frame->skeletons) {
    body->take(skeleton, data[0] > 127);
    JointFigure figure;
    Pose pose;
    Hands hands;
    figure.fit(body->figure(), pose);
    if (body->hands(hands)) DANCE_ASSERT(is_valid(hands));
  }
  return 0;
}
