// The way back of dance_adapter.h: each pose of an engine's tracker is one datagram to the house.

#include <memory>
#include <new>
#include <string>

#include "consumers/engine/adapter/axes.h"
#include "consumers/engine/adapter/caller_struct.h"
#include "consumers/engine/dance_adapter.h"
#include "core/base/guest_id.h"
#include "core/net/local_address.h"
#include "core/net/local_datagram.h"
#include "core/net/mono_clock.h"
#include "formats/engine/datagram.h"
#include "formats/engine/segment.h"

using dance::Duration;
using dance::LocalDatagramSender;
using dance::MonoTime;
using dance::engine::Axes;
using dance::engine::fits;

struct dance_producer {
  std::unique_ptr<LocalDatagramSender> sender;
  const Axes& axes;
  std::uint64_t session;
  bool has_skeleton = false;
  dance::Skeleton skeleton;
  MonoTime next_skeleton;
  dance::engine::DatagramBuffer buffer;
};

namespace {

// A house that is started later needs the proportions too.
constexpr Duration kSkeletonPeriod = Duration::s(1);

template <class Value>
dance_status send_value(dance_producer& producer, const Value& value, MonoTime now) {
  switch (
      producer.sender->send(dance::engine::encode(producer.session, value, producer.buffer), now)) {
    case LocalDatagramSender::Sent::kSent:
      return DANCE_OK;
    case LocalDatagramSender::Sent::kNobody:
      return DANCE_NO_HOUSE;
    case LocalDatagramSender::Sent::kFull:
      return DANCE_BUSY;
  }
  return DANCE_NO_HOUSE;
}

// The caller's time, 0: now. Not set for one that is no time.
MonoTime capture_time(std::int64_t capture_ns, MonoTime now) {
  if (capture_ns == 0) return now;
  return dance::engine::is_time(capture_ns) ? MonoTime::from_ns(capture_ns) : MonoTime();
}

dance_producer* open_producer(const dance::GuestId& name, const Axes& axes) {
  const std::string path =
      dance::local_socket_folder() + "/" + dance::engine::kSocketPrefix + std::string(name.view());
  auto sender = LocalDatagramSender::open(path);
  if (!sender) return nullptr;
  const auto session = static_cast<std::uint64_t>(dance::mono_now().since_zero_ns());
  return new dance_producer{std::move(*sender), axes, session, false, {}, {}, {}};
}

}  // namespace

dance_producer* dance_producer_open(const char* name, dance_axes axes) {
  const auto id = dance::GuestId::parse(name && *name ? name : "stage");
  const Axes* found = dance::engine::find_axes(static_cast<int>(axes));
  if (!id || !found) return nullptr;
  try {
    return open_producer(*id, *found);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void dance_producer_close(dance_producer* producer) { delete producer; }

dance_status dance_producer_skeleton(dance_producer* producer, const dance_skeleton* skeleton) {
  if (!producer || !fits(skeleton)) return DANCE_BAD_ARGUMENT;
  dance::Skeleton ours;
  for (std::size_t b = 0; b < dance::kBoneCount; ++b)
    producer->axes.point_in(skeleton->offset[b], ours.offset_m[b].data());
  for (std::size_t t = 0; t < dance::kTipCount; ++t)
    producer->axes.point_in(skeleton->tip[t], ours.tip_m[t].data());
  if (!is_valid(ours)) return DANCE_INVALID;
  producer->skeleton = ours;
  producer->has_skeleton = true;
  const MonoTime now = dance::mono_now();
  producer->next_skeleton = now + kSkeletonPeriod;
  return send_value(*producer, ours, now);
}

dance_status dance_producer_pose(dance_producer* producer, const dance_pose* pose) {
  if (!producer || !fits(pose)) return DANCE_BAD_ARGUMENT;
  const MonoTime now = dance::mono_now();
  dance::Pose ours;
  producer->axes.rotations_in(pose->rotation[0], ours.R_PB[0].coeffs().data(), dance::kBoneCount);
  producer->axes.point_in(pose->hips_position, ours.p_WH_m.data());
  ours.presence = pose->presence & dance::kAllBones;
  ours.confidence = pose->confidence;
  ours.capture_time = capture_time(pose->capture_ns, now);
  if (!is_valid(ours) || !ours.capture_time.is_set()) return DANCE_INVALID;
  if (producer->has_skeleton && now >= producer->next_skeleton) {
    // As the poses': a house that is not there, or does not read, gets it later.
    if (send_value(*producer, producer->skeleton, now) == DANCE_OK)
      producer->next_skeleton = now + kSkeletonPeriod;
  }
  return send_value(*producer, ours, now);
}

dance_status dance_producer_hands(dance_producer* producer, const dance_hands* hands) {
  if (!producer || !fits(hands)) return DANCE_BAD_ARGUMENT;
  const MonoTime now = dance::mono_now();
  dance::Hands ours;
  producer->axes.rotations_in(hands->rotation[0], ours.R_PB[0].coeffs().data(),
                              dance::kFingerBoneCount);
  ours.presence = hands->presence & dance::engine::kAllFingers;
  ours.capture_time = capture_time(hands->capture_ns, now);
  if (!is_valid(ours) || !ours.capture_time.is_set()) return DANCE_INVALID;
  return send_value(*producer, ours, now);
}
