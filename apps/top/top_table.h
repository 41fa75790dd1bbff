// The traffic of a bus: rate, bytes, type and age of each channel, and the statistics that programs
// publish. `dance top` prints it.
//
// Units/frames: now is this process's clock; rates are per second since the last table.
// Ownership:    keeps at most kMaxChannels channels and kMaxPrograms programs, whatever is sent.
// Threads:      none inside; one owner.
// Failure:      what is beyond the bounds is counted and said; names are shown with odd characters
//               replaced.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "core/base/steps.h"
#include "core/base/time.h"
#include "core/bus/messages.h"
#include "core/signal/flow_setting.h"
#include "core/signal/playout.h"
#include "core/signal/style.h"

namespace dance {

// The type that made a message, by its fingerprint: "pose_t"; "" for what is none of ours.
std::string_view type_of_message(std::span<const std::uint8_t> message);

class TopTable {
 public:
  static constexpr std::size_t kMaxChannels = 256;
  static constexpr std::size_t kMaxPrograms = 64;

  void take(std::string_view channel, std::span<const std::uint8_t> message, MonoTime now);
  // The table as text, and a new beginning for the rates.
  std::string text(MonoTime now);

  std::size_t channel_count() const { return channels_.size(); }
  std::uint64_t beyond_bounds() const { return beyond_bounds_; }

 private:
  struct ChannelRow {
    std::uint64_t messages = 0;  // since the last table
    std::uint64_t bytes = 0;
    std::uint64_t all_messages = 0;
    MonoTime last;
    std::string_view type;
  };
  struct StyleRow {
    Style style;
    MonoTime last;
  };
  struct FiguresRow {
    GuestStats stats;
    MonoTime last;
  };
  struct FlowRow {
    FlowSetting setting;
    MonoTime last;
  };
  struct PlayoutRow {
    Playout playout;
    MonoTime last;
  };
  struct StepsRow {
    Steps steps;
    MonoTime last;
  };
  struct ProgramRow {
    Stats stats;
    MonoTime last;
  };

  void append_channels(std::string& out, MonoTime now, double seconds);
  void take_style(std::string_view name, std::span<const std::uint8_t> message, MonoTime now);
  void append_styles(std::string& out) const;
  void append_figures(std::string& out) const;
  void append_flows(std::string& out) const;
  void append_playouts(std::string& out) const;
  void append_steps(std::string& out) const;
  void append_programs(std::string& out, MonoTime now) const;

  std::map<std::string, ChannelRow, std::less<>> channels_;
  std::map<std::string, ProgramRow, std::less<>> programs_;
  std::map<std::string, StyleRow, std::less<>> styles_;      // by channel, at most kMaxPrograms
  std::map<std::string, FiguresRow, std::less<>> figures_;   // by guest, likewise
  std::map<std::string, FlowRow, std::less<>> flows_;        // by guest, likewise
  std::map<std::string, PlayoutRow, std::less<>> playouts_;  // by guest, likewise
  std::map<std::string, StepsRow, std::less<>> steps_;       // by channel, likewise
  std::uint64_t beyond_bounds_ = 0;
  MonoTime begin_;
};

}  // namespace dance
