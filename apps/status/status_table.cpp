#include "apps/status/status_table.h"

#include <fmt/format.h>

#include <iterator>

#include "apps/status/status_json.h"

namespace dance {
namespace {

using namespace status_json;

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
  fmt::format_to(std::back_inserter(out),
                 "{:<17}{:<17}{:>10}{:>10}{:>8}{:>8}{:>10}{:>10}{:>8}{:>8}{:>8}{:>9}  {}\n", guest,
                 room, cell(number(link, "round_trip_ms"), 1, 2, " ms"),
                 cell(jitter_ms, 1, 2, " ms"), cell(number(link, "loss_up"), 100, 1, "%"),
                 cell(number(link, "loss_down"), 100, 1, "%"),
                 cell(number(link, "bytes_in_per_s"), 1e-3, 1, " kB"),
                 cell(number(link, "bytes_out_per_s"), 1e-3, 1, " kB"),
                 cell(number(link, "voices_in_per_s"), 1, 0, ""),
                 cell(number(link, "voices_out_per_s"), 1, 0, ""),
                 cell(number(link, "last_heard_s"), 1, 1, " s"),
                 cell(number(link, "age_s"), 1, 0, " s"), text(link, "peer"));
}

void add_guests(const json& rooms, std::string& out) {
  fmt::format_to(std::back_inserter(out),
                 "\n{:<17}{:<17}{:>10}{:>10}{:>8}{:>8}{:>10}{:>10}{:>8}{:>8}{:>8}{:>9}  {}\n",
                 "guest", "room", "rtt", "jitter", "lost up", "down", "in/s", "out/s", "speaks",
                 "hears", "heard", "here", "from");
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
