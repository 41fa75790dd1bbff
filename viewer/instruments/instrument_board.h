// InstrumentBoard: where the thread that hears the bus leaves figures and settings of guests, and
// the drawing thread finds them; and the other way round, what a panel asks for.
//
// Units/frames: times of the house's clock.
// Ownership:    owns the meter and bounded rings; never allocates after construction.
// Threads:      on_*(), end_seconds() and take_asked_*() on the bus thread; take_*() and ask() on
//               the drawing thread.
// Failure:      a display that draws nothing for long misses the oldest figures.
#pragma once

#include <optional>

#include "core/base/spsc_ring.h"
#include "core/bus/encode.h"
#include "viewer/instruments/instruments_meter.h"

namespace dance {

template <class T>
struct OfGuest {
  GuestId guest;
  T what;
};

class InstrumentBoard {
 public:
  explicit InstrumentBoard(std::uint64_t clock_id) : meter_(clock_id) {}

  void on_pose(Where where, const GuestId& guest, const Pose& pose, MonoTime now) {
    meter_.on_pose(where, guest, pose, now);
  }
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton) {
    meter_.on_skeleton(guest, skeleton);
  }
  void on_beat(const Beat& beat) { meter_.on_beat(beat); }
  void on_shown(const GuestId& guest, const StageTime& shown) { meter_.on_shown(guest, shown); }
  void on_traffic(const GuestId& guest, const GuestTraffic& traffic) {
    meter_.on_traffic(guest, traffic);
  }
  void on_flow(const GuestId& guest, const FlowSetting& setting) {
    meter_.on_flow(guest, setting);
    flows_.push({guest, setting});
  }
  void on_playout(const GuestId& guest, const Playout& playout) {
    playouts_.push({guest, playout});
  }
  // Of a recording: any message, as it was; `now` is of the recorded house's clock.
  void on_message(const Channel& channel, const void* data, std::size_t size, MonoTime now);

  template <class Say>
  void end_seconds(MonoTime now, Say say) {
    meter_.end_seconds(now, [&](const GuestId& guest, const GuestStats& stats) {
      figures_.push({guest, stats});
      say(guest, stats);
    });
  }
  std::optional<OfGuest<FlowSetting>> take_asked_flow() { return asked_flows_.pop(); }
  std::optional<OfGuest<Style>> take_asked_style() { return asked_styles_.pop(); }

  std::optional<OfGuest<GuestStats>> take_figures() { return figures_.pop(); }
  std::optional<OfGuest<FlowSetting>> take_flow() { return flows_.pop(); }
  std::optional<OfGuest<Playout>> take_playout() { return playouts_.pop(); }
  void ask(const GuestId& guest, const FlowSetting& setting) {
    asked_flows_.push({guest, setting});
  }
  void ask(const GuestId& guest, const Style& style) { asked_styles_.push({guest, style}); }

 private:
  InstrumentsMeter meter_;
  MonoTime looked_;  // of a recording
  SpscRing<OfGuest<GuestStats>, 256> figures_;
  SpscRing<OfGuest<FlowSetting>, 256> flows_;
  SpscRing<OfGuest<Playout>, 256> playouts_;
  SpscRing<OfGuest<FlowSetting>, 128> asked_flows_;
  SpscRing<OfGuest<Style>, 128> asked_styles_;
};

}  // namespace dance
