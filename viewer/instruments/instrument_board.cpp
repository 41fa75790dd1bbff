#include "viewer/instruments/instrument_board.h"

namespace dance {
namespace {

constexpr Duration kLook = Duration::ms(100);

template <class T, class Use>
void read(const void* data, std::size_t size, Use use) {
  if (T message; decode(data, size, message) == Decoded::kFine) use(message);
}

}  // namespace

void InstrumentBoard::on_message(const Channel& channel, const void* data, std::size_t size,
                                 MonoTime now) {
  const GuestId& guest = channel.guest();
  switch (channel.signal()) {
    case Signal::kPose:
      read<Pose>(data, size, [&](auto& pose) { on_pose(channel.where(), guest, pose, now); });
      break;
    case Signal::kSkeleton:
      read<TimedSkeleton>(data, size, [&](auto& timed) { on_skeleton(guest, timed.skeleton); });
      break;
    case Signal::kBeat:
      read<Beat>(data, size, [&](auto& beat) { on_beat(beat); });
      break;
    case Signal::kStageTime:
      read<StageTime>(data, size, [&](auto& shown) { on_shown(guest, shown); });
      break;
    case Signal::kGuestTraffic:
      read<GuestTraffic>(data, size, [&](auto& traffic) { on_traffic(guest, traffic); });
      break;
    case Signal::kFlow:
      if (channel.where() == Where::kStage)
        read<FlowSetting>(data, size, [&](auto& setting) { on_flow(guest, setting); });
      break;
    case Signal::kPlayout:
      read<Playout>(data, size, [&](auto& playout) { on_playout(guest, playout); });
      break;
    default:
      break;
  }
  if (now - looked_ < kLook && now >= looked_) return;
  looked_ = now;
  end_seconds(now, [](const GuestId&, const GuestStats&) {});
}

}  // namespace dance
