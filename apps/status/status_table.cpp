#include "apps/status/status_table.h"

#include <fmt/format.h>

#include <iterator>
#include <optional>

namespace dance {
namespace {

using json = nlohmann::ordered_json;

const json& member(const json& object, const char* key) {
  static const json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

std::optional<double> number(const json& object, const char* key) {
  const json& value = member(object, key);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

// Names are untrusted: control characters do not reach the terminal.
std::string text(const json& object, const char* key) {
  const json& value = member(object, key);
  std::string out = value.is_string() ? value.get<std::string>().substr(0, 48) : "-";
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out;
}

std::string cell(std::optional<double> value, double scale, int digits, const char* unit) {
  return value ? fmt::format("{:.{}f}{}", *value * scale, digits, unit) : std::string("-");
}

// The objects of a list; none where there is no list.
template <class Do>
void each(const json& list, Do act) {
  if (!list.is_array()) return;
  for (const json& entry : list) act(entry);
}

void add_rooms(const json& rooms, std::string& out) {
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "{:<25}{:>7}{:>11}  {:<10}{:>9}\n", "room", "guests", "listeners", "codec",
                 "shares");
  each(rooms, [&](const json& room) {
    fmt::format_to(back, "{:<25}{:>7}{:>11}  {:<10}{:>9}\n", text(room, "name"),
                   cell(number(room, "guests"), 1, 0, ""),
                   cell(number(room, "listeners"), 1, 0, ""), text(room, "codec"),
                   cell(number(room, "share_window_ms"), 1, 2, " ms"));
  });
}

void add_line(const std::string& guest, const std::string& room, const json& link,
              std::optional<double> jitter_ms, std::string& out) {
  fmt::format_to(
      std::back_inserter(out), "{:<17}{:<17}{:>10}{:>10}{:>8}{:>8}{:>10}{:>10}{:>8}{:>9}  {}\n",
      guest, room, cell(number(link, "round_trip_ms"), 1, 2, " ms"), cell(jitter_ms, 1, 2, " ms"),
      cell(number(link, "loss_up"), 100, 1, "%"), cell(number(link, "loss_down"), 100, 1, "%"),
      cell(number(link, "bytes_in_per_s"), 1e-3, 1, " kB"),
      cell(number(link, "bytes_out_per_s"), 1e-3, 1, " kB"),
      cell(number(link, "last_heard_s"), 1, 1, " s"), cell(number(link, "age_s"), 1, 0, " s"),
      text(link, "peer"));
}

void add_guests(const json& rooms, std::string& out) {
  fmt::format_to(std::back_inserter(out),
                 "\n{:<17}{:<17}{:>10}{:>10}{:>8}{:>8}{:>10}{:>10}{:>8}{:>9}  {}\n", "guest",
                 "room", "rtt", "jitter", "lost up", "down", "in/s", "out/s", "heard", "here",
                 "from");
  each(rooms, [&](const json& room) {
    each(member(room, "links"), [&](const json& link) {
      const json& guests = member(link, "guests");
      if (guests.empty()) add_line("(listens)", text(room, "name"), link, std::nullopt, out);
      each(guests, [&](const json& guest) {
        add_line(text(guest, "name"), text(room, "name"), link, number(guest, "jitter_ms"), out);
      });
    });
  });
}

// Only what has happened.
void add_causes(const char* title, const json& causes, std::string& out) {
  if (!causes.is_object()) return;
  std::string line;
  for (const auto& [name, count] : causes.items()) {
    if (!count.is_number() || count.get<double>() == 0.0) continue;
    line += fmt::format("  {} {:.0f}", text(json{{"name", name}}, "name"), count.get<double>());
  }
  if (!line.empty()) out += std::string("\n") + title + ":" + line + "\n";
}

}  // namespace

std::string status_text(const json& status) {
  const json& rooms = member(status, "rooms");
  std::string out =
      fmt::format("dance server {} on {}, up {}\n\n", text(status, "version"),
                  text(status, "address"), cell(number(status, "uptime_s"), 1, 0, " s"));
  if (rooms.empty()) {
    out += "(nobody is here)\n";
  } else {
    add_rooms(rooms, out);
    add_guests(rooms, out);
  }
  add_causes("dropped", member(status, "rejects"), out);
  add_causes("handshakes", member(status, "handshakes"), out);
  return out;
}

}  // namespace dance
