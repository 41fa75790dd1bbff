#include "apps/top/top_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/bus/channel.h"
#include "core/bus/encode.h"

namespace dance {
namespace {

// Eviction: channels that have been silent for so long make room for others.
constexpr Duration kForgotten = Duration::s(60);

template <class Message>
bool read(std::span<const std::uint8_t> bytes, Message& message) {
  return decode(bytes.data(), bytes.size(), message) == Decoded::kFine;
}

// The newest of each name, of at most so many.
template <class Rows, class Row>
void keep(Rows& rows, std::string_view name, const Row& row, std::size_t most) {
  const auto known = rows.find(name);
  if (known != rows.end())
    known->second = row;
  else if (rows.size() < most)
    rows.emplace(name, row);
}

// A figure, or a dash where it is not known.
std::string figure(float value, const char* format = "{:.0f}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

// Names are untrusted: control characters do not reach the terminal.
std::string printable(std::string_view name) {
  std::string text(name.substr(0, kMaxChannelLength));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

}  // namespace

std::string_view type_of_message(std::span<const std::uint8_t> message) {
  if (message.size() < sizeof(std::uint64_t)) return "";
  std::uint64_t fingerprint = 0;
  for (const std::uint8_t byte : message.first<sizeof fingerprint>())
    fingerprint = fingerprint << 8 | byte;
  std::string_view type;
  for_each_message_type([&]<class Message>() {
    if (MessageTraits<Message>::fingerprint() == fingerprint)
      type = MessageTraits<Message>::type_name();
  });
  return type;
}

void TopTable::take(std::string_view name, std::span<const std::uint8_t> message, MonoTime now) {
  if (!begin_.is_set()) begin_ = now;
  auto row = channels_.find(name);
  if (row == channels_.end()) {
    if (channels_.size() == kMaxChannels) {
      ++beyond_bounds_;
      return;
    }
    row = channels_.emplace(name, ChannelRow()).first;
  }
  ChannelRow& channel = row->second;
  ++channel.messages;
  ++channel.all_messages;
  channel.bytes += message.size();
  channel.last = now;
  channel.type = type_of_message(message);

  const auto parsed = Channel::parse(name);
  if (parsed && parsed->signal() == Signal::kStyle) take_style(name, message, now);
  if (parsed && parsed->signal() == Signal::kGuestStats) {
    if (FiguresRow it{{}, now}; read(message, it.stats))
      keep(figures_, parsed->guest().view(), it, kMaxPrograms);
  }
  if (parsed && parsed->signal() == Signal::kPlayout) {
    if (PlayoutRow it{{}, now}; read(message, it.playout))
      keep(playouts_, parsed->guest().view(), it, kMaxPrograms);
  }
  if (parsed && parsed->signal() == Signal::kSteps) {
    if (StepsRow it{{}, now}; read(message, it.steps)) keep(steps_, name, it, kMaxPrograms);
  }
  if (parsed && parsed->signal() == Signal::kFlow && parsed->where() == Where::kStage) {
    if (FlowRow it{{}, now}; read(message, it.setting))
      keep(flows_, parsed->guest().view(), it, kMaxPrograms);
  }
  ProgramRow program{Stats(), now};
  if (!parsed || parsed->signal() != Signal::kStats) return;
  if (decode(message.data(), message.size(), program.stats) != Decoded::kFine) return;
  const auto known = programs_.find(parsed->program());
  if (known != programs_.end())
    known->second = program;
  else if (programs_.size() < kMaxPrograms)
    programs_.emplace(parsed->program(), program);
}

void TopTable::take_style(std::string_view name, std::span<const std::uint8_t> message,
                          MonoTime now) {
  StyleRow row{Style(), now};
  if (decode(message.data(), message.size(), row.style) != Decoded::kFine) return;
  const auto known = styles_.find(name);
  if (known != styles_.end())
    known->second = row;
  else if (styles_.size() < kMaxPrograms)
    styles_.emplace(name, row);
}

void TopTable::append_styles(std::string& out) const {
  const auto back = std::back_inserter(out);
  if (!styles_.empty())
    fmt::format_to(back, "\n{:<34}{:>6}{:>7}{:>10}{:>6}{:>7}{:>6}{:>6}{:>10}{:>9}\n", "style",
                   "hips", "torso", "shoulders", "arms", "hands", "legs", "head", "periodic",
                   "dynamic");
  for (const auto& [name, row] : styles_) {
    const auto& gain = row.style.gain;
    fmt::format_to(
        back, "{:<34}{:>6.2f}{:>7.2f}{:>10.2f}{:>6.2f}{:>7.2f}{:>6.2f}{:>6.2f}{:>10.2f}{:>9.2f}\n",
        printable(name), gain[0], gain[1], gain[2], gain[3], gain[4], gain[5], gain[6],
        row.style.periodic, row.style.dynamic);
  }
}

void TopTable::append_figures(std::string& out) const {
  const auto back = std::back_inserter(out);
  constexpr const char* kRow =
      "{:<25}{:>9}{:>6}{:>6}{:>6}{:>7}{:>7}{:>7}{:>7}{:>6}{:>7}{:>7}{:>7}\n";
  if (!figures_.empty())
    fmt::format_to(back, fmt::runtime("\n" + std::string(kRow)), "shown", "capture", "way", "shown",
                   "age", "jitter", "loss %", "B/s", "ahead", "mm", "p95 mm", "hips", "beat");
  for (const auto& [name, row] : figures_) {
    const GuestStats& s = row.stats;
    fmt::format_to(back, fmt::runtime(kRow), printable(name), figure(s.gap_p50_ms[0]),
                   figure(s.newest_p50_ms), figure(s.gap_p50_ms[kShownGap]), figure(s.age_p50_ms),
                   figure(s.jitter_ms, "{:.1f}"), figure(s.loss_percent, "{:.1f}"),
                   figure(s.bytes_per_second), figure(s.horizon_p50_ms), figure(s.error_mean_mm),
                   figure(s.error_p95_mm), figure(s.hips_error_mm), figure(s.beat_ms, "{:+.0f}"));
  }
}

void TopTable::append_flows(std::string& out) const {
  const auto back = std::back_inserter(out);
  constexpr const char* kRow = "{:<25}{:>7}{:>9}{:>6}{:>9}{:>8}{:>8}{:>7}{:>10}\n";
  if (!flows_.empty())
    fmt::format_to(back, fmt::runtime("\n" + std::string(kRow)), "flow", "hold", "predict", "lead",
                   "bridge", "rhythm", "beats", "", "stylize");
  for (const auto& [name, row] : flows_) {
    const FlowSetting& s = row.setting;
    const auto word = [&](FlowWord it) {
      return s.has_word(it) ? s.is_on(it) ? "on" : "off" : "-";
    };
    const std::string beats = !s.has_word(FlowWord::kRhythm) ? "-"
                              : s.rhythm_beats < 0.0f        ? "auto"
                                                             : figure(s.rhythm_beats);
    const std::string strength =
        s.has_word(FlowWord::kRhythm) ? figure(s.rhythm_strength, "{:.2f}") : "-";
    fmt::format_to(back, fmt::runtime(kRow), printable(name), word(FlowWord::kHold),
                   word(FlowWord::kPredict), figure(s.lead, "{:.2f}"), word(FlowWord::kBridge),
                   word(FlowWord::kRhythm), beats, strength, word(FlowWord::kStylize));
  }
}

void TopTable::append_playouts(std::string& out) const {
  const auto back = std::back_inserter(out);
  if (!playouts_.empty()) out += "\nshown, and why\n";
  for (const auto& [name, row] : playouts_)
    fmt::format_to(back, "{:<25}{}\n", printable(name), playout_text(row.playout));
}

void TopTable::append_steps(std::string& out) const {
  const auto back = std::back_inserter(out);
  constexpr const char* kRow = "{:<34}{:>8}{:>8}{:>9}{:>9}\n";
  if (!steps_.empty())
    fmt::format_to(back, fmt::runtime("\n" + std::string(kRow)), "steps", "a min", "weight",
                   "dancers", "where");
  for (const auto& [name, row] : steps_) {
    const Steps& s = row.steps;
    fmt::format_to(back, fmt::runtime(kRow), printable(name),
                   s.tempo_bpm > 0.0 ? fmt::format("{:.1f}", s.tempo_bpm) : "-",
                   figure(s.weight, "{:.2f}"), s.dancers, s.is_remote ? "away" : "here");
  }
}

std::string TopTable::text(MonoTime now) {
  const double seconds = begin_.is_set() ? std::max((now - begin_).as_seconds(), 1e-3) : 1.0;
  std::string out;
  append_channels(out, now, seconds);
  append_styles(out);
  append_flows(out);
  append_playouts(out);
  append_steps(out);
  append_figures(out);
  append_programs(out, now);
  if (beyond_bounds_ > 0)
    fmt::format_to(std::back_inserter(out), "{} messages on more channels than the table holds\n",
                   beyond_bounds_);
  for (auto& [name, row] : channels_) row.messages = row.bytes = 0;
  std::erase_if(channels_, [&](const auto& entry) { return now - entry.second.last > kForgotten; });
  std::erase_if(styles_, [&](const auto& entry) { return now - entry.second.last > kForgotten; });
  std::erase_if(figures_, [&](const auto& entry) { return now - entry.second.last > kForgotten; });
  std::erase_if(flows_, [&](const auto& entry) { return now - entry.second.last > kForgotten; });
  std::erase_if(playouts_, [&](const auto& entry) { return now - entry.second.last > kForgotten; });
  std::erase_if(steps_, [&](const auto& entry) { return now - entry.second.last > kForgotten; });
  std::erase_if(programs_, [&](const auto& entry) { return now - entry.second.last > kForgotten; });
  begin_ = now;
  return out;
}

void TopTable::append_channels(std::string& out, MonoTime now, double seconds) {
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "{:<34}{:>8}{:>11}{:>9}  {:<14}{:>10}\n", "channel", "Hz", "bytes/s", "age",
                 "type", "messages");
  for (const auto& [name, row] : channels_) {
    fmt::format_to(back, "{:<34}{:>8.1f}{:>11.0f}{:>7.1f} s  {:<14}{:>10}\n", printable(name),
                   static_cast<double>(row.messages) / seconds,
                   static_cast<double>(row.bytes) / seconds,
                   std::max(0.0, (now - row.last).as_seconds()),
                   row.type.empty() ? "(not ours)" : row.type, row.all_messages);
  }
  if (channels_.empty()) out += "(nobody speaks)\n";
}

void TopTable::append_programs(std::string& out, MonoTime now) const {
  if (programs_.empty()) return;
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "\n{:<14}{:>9}{:>10}{:>10}{:>8}{:>9}{:>8}{:>10}{:>11}{:>8}\n", "program",
                 "up", "received", "forwarded", "lost", "dropped", "guests", "rtt", "lateness",
                 "age");
  for (const auto& [name, row] : programs_) {
    const Stats& s = row.stats;
    const std::int64_t dropped =
        s.dropped_late + s.dropped_invalid + s.dropped_unrouted + s.dropped_overflow;
    fmt::format_to(
        back, "{:<14}{:>7.0f} s{:>10}{:>10}{:>8}{:>9}{:>8}{:>7.1f} ms{:>8.1f} ms{:>6.1f} s\n",
        printable(name), s.uptime.as_seconds(), s.received, s.forwarded, s.lost, dropped, s.guests,
        s.round_trip.as_ms(), s.lateness_p99.as_ms(), (now - row.last).as_seconds());
  }
}

}  // namespace dance
