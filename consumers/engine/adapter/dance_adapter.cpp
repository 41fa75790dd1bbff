#include "consumers/engine/dance_adapter.h"

#include <algorithm>
#include <memory>
#include <string_view>

#include "consumers/engine/adapter/caller_struct.h"
#include "consumers/engine/adapter/stage_reader.h"
#include "core/net/mono_clock.h"

using dance::GuestId;
using dance::engine::clear_unknown;
using dance::engine::fits;
using dance::engine::is_time;
using dance::engine::Outcome;
using dance::engine::StageReader;

struct dance_adapter {
  StageReader reader;
};

namespace {

dance_status refresh(dance_adapter* adapter) {
  return adapter->reader.refresh(dance::mono_now().since_zero_ns());
}

// What every call about a dancer begins and ends with. `read` leaves the struct as it was where it
// fails: the caller goes on with what it had.
template <class T, class Read>
dance_status read_slot(dance_adapter* adapter, std::uint32_t slot, T* out, Read&& read) {
  if (!adapter || slot >= DANCE_MAX_GUESTS || !fits(out)) return DANCE_BAD_ARGUMENT;
  if (const dance_status status = refresh(adapter); status != DANCE_OK) return status;
  const dance_status status = read(adapter->reader);
  if (status == DANCE_OK) clear_unknown(out);
  if (status == DANCE_BUSY) adapter->reader.count_busy();
  return status;
}

}  // namespace

dance_adapter* dance_adapter_open(const char* name, dance_axes axes) {
  const auto id = GuestId::parse(name && *name ? name : "stage");
  const dance::engine::Axes* found = dance::engine::find_axes(static_cast<int>(axes));
  if (!id || !found) return nullptr;
  try {
    return new dance_adapter{StageReader(*id, *found)};
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void dance_adapter_close(dance_adapter* adapter) { delete adapter; }

dance_status dance_adapter_state(dance_adapter* adapter) {
  return adapter ? refresh(adapter) : DANCE_BAD_ARGUMENT;
}

uint32_t dance_adapter_guests(dance_adapter* adapter, dance_guest* guests, uint32_t capacity) {
  if (!adapter || (capacity > 0 && !fits(guests)) || refresh(adapter) != DANCE_OK) return 0;
  const std::uint32_t bytes = capacity > 0 ? guests->struct_size : 0;
  std::uint32_t count = 0;
  for (std::uint32_t slot = 0; slot < DANCE_MAX_GUESTS; ++slot) {
    dance_guest guest;
    if (adapter->reader.guest(slot, guest) != Outcome::kFine) continue;
    if (count < capacity) {
      // An array of the caller's structs, which may be longer than ours.
      auto* place = reinterpret_cast<unsigned char*>(guests) + std::size_t{count} * bytes;
      guest.struct_size = bytes;
      std::memcpy(place, &guest, sizeof guest);
      std::memset(place + sizeof guest, 0, bytes - sizeof guest);
    }
    ++count;
  }
  return count;
}

dance_status dance_adapter_find(dance_adapter* adapter, const char* id, uint32_t* slot) {
  if (!adapter || !id || !slot || !GuestId::parse(id)) return DANCE_BAD_ARGUMENT;
  if (const dance_status status = refresh(adapter); status != DANCE_OK) return status;
  for (std::uint32_t i = 0; i < DANCE_MAX_GUESTS; ++i) {
    dance_guest guest;
    if (adapter->reader.guest(i, guest) != Outcome::kFine || std::strcmp(guest.id, id) != 0)
      continue;
    *slot = i;
    return DANCE_OK;
  }
  return DANCE_NO_GUEST;
}

dance_status dance_adapter_newest(dance_adapter* adapter, uint32_t slot, dance_pose* pose) {
  return read_slot(adapter, slot, pose,
                   [&](StageReader& reader) { return reader.newest(slot, *pose); });
}

dance_status dance_adapter_at(dance_adapter* adapter, uint32_t slot, int64_t time_ns,
                              dance_pose* pose) {
  if (!is_time(time_ns)) return DANCE_BAD_ARGUMENT;
  return read_slot(adapter, slot, pose,
                   [&](StageReader& reader) { return reader.at(slot, time_ns, *pose); });
}

dance_status dance_adapter_skeleton(dance_adapter* adapter, uint32_t slot,
                                    dance_skeleton* skeleton) {
  return read_slot(adapter, slot, skeleton,
                   [&](StageReader& reader) { return reader.skeleton(slot, *skeleton); });
}

dance_status dance_adapter_hands(dance_adapter* adapter, uint32_t slot, dance_hands* hands) {
  return read_slot(adapter, slot, hands,
                   [&](StageReader& reader) { return reader.hands(slot, *hands); });
}

dance_status dance_adapter_beat(dance_adapter* adapter, int64_t time_ns, dance_beat* beat) {
  if (!is_time(time_ns)) return DANCE_BAD_ARGUMENT;
  return read_slot(adapter, 0, beat,
                   [&](StageReader& reader) { return reader.beat(time_ns, *beat); });
}

dance_status dance_adapter_counters(dance_adapter* adapter, dance_counters* counters) {
  if (!adapter || !fits(counters)) return DANCE_BAD_ARGUMENT;
  const std::uint32_t bytes = counters->struct_size;
  *counters = adapter->reader.counters();
  counters->struct_size = bytes;
  clear_unknown(counters);
  return DANCE_OK;
}
