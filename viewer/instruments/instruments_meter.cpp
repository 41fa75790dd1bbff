#include "viewer/instruments/instruments_meter.h"

#include "core/base/raw_twin.h"

namespace dance {
namespace {

constexpr Duration kGone = Duration::s(3);
constexpr Duration kSlotHolds = Duration::s(10);

}  // namespace

InstrumentsMeter::InstrumentsMeter(std::uint64_t clock_id)
    : clock_id_(clock_id), music_(clock_id), slots_(std::make_unique<Slot[]>(kMaxGuests)) {}

bool InstrumentsMeter::is_present(const Slot& slot, MonoTime now) {
  return now - slot.heard < kGone;
}

InstrumentsMeter::Slot* InstrumentsMeter::find(const GuestId& guest) {
  for (std::size_t i = 0; i < kMaxGuests; ++i)
    if (slots_[i].guest == guest) return &slots_[i];
  return nullptr;
}

InstrumentsMeter::Slot* InstrumentsMeter::slot_of(const GuestId& guest, MonoTime now) {
  if (Slot* slot = find(guest)) {
    slot->heard = now;
    return slot;
  }
  Slot* spare = nullptr;
  for (std::size_t i = 0; i < kMaxGuests; ++i) {
    Slot& slot = slots_[i];
    const bool is_free = !slot.guest.is_set() || now - slot.heard > kSlotHolds || now < slot.heard;
    if (is_free && (spare == nullptr || slot.heard < spare->heard)) spare = &slot;
  }
  if (spare == nullptr) return nullptr;
  spare->guest = guest;
  spare->is_twin = twin_of_whom(guest).has_value();
  spare->heard = now;
  spare->meter = GuestMeter(clock_id_);
  return spare;
}

void InstrumentsMeter::on_pose(Where where, const GuestId& guest, const Pose& pose, MonoTime now) {
  if (where == Where::kCapture) music_.see(pose);
  Slot* slot = slot_of(guest, now);
  if (slot == nullptr || slot->is_twin) return;
  if (where == Where::kStage)
    slot->meter.on_staged(pose, now, music_.clock());
  else
    slot->meter.on_arrived(pose, now, music_.clock());
}

void InstrumentsMeter::on_skeleton(const GuestId& guest, const Skeleton& skeleton) {
  if (Slot* slot = find(guest)) slot->meter.set_body(skeleton);
}

void InstrumentsMeter::on_shown(const GuestId& guest, const StageTime& shown) {
  if (Slot* slot = find(guest)) slot->meter.on_shown(shown);
}

void InstrumentsMeter::on_flow(const GuestId& guest, const FlowSetting& setting) {
  if (Slot* slot = find(guest)) slot->meter.on_flow(setting);
}

void InstrumentsMeter::on_traffic(const GuestId& guest, const GuestTraffic& traffic) {
  if (Slot* slot = find(guest)) slot->meter.on_traffic(traffic);
}

}  // namespace dance
