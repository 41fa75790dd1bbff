#include "apps/status/status_table.h"

#include <fmt/format.h>

#include <iterator>

#include "apps/status/status_json.h"
#include "tunnel/seal/keys/utc_text.h"

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

// Text for the expiry of a key.
std::string key_expiry(const json& link) {
  const json& until = member(link, "key_until_utc_s");
  if (!until.is_number_unsigned()) return "";
  return ", key until " + utc_shown(until.get<std::int64_t>());
}

struct GuestCells {
  std::string id, shown_name;
  std::optional<double> jitter_ms;
};

void add_line(const GuestCells& guest, const std::string& room, const json& link,
              std::string& out) {
  fmt::format_to(std::back_inserter(out),
                 "{:<17}{:<21}{:<17}{:>10}{:>10}{:>8}{:>8}{:>10}{:>10}{:>8}{:>8}{:>8}{:>9}  {}{}\n",
                 guest.id, guest.shown_name, room, cell(number(link, "round_trip_ms"), 1, 2, " ms"),
                 cell(guest.jitter_ms, 1, 2, " ms"), cell(number(link, "loss_up"), 100, 1, "%"),
                 cell(number(link, "loss_down"), 100, 1, "%"),
                 cell(number(link, "bytes_in_per_s"), 1e-3, 1, " kB"),
                 cell(number(link, "bytes_out_per_s"), 1e-3, 1, " kB"),
                 cell(number(link, "voices_in_per_s"), 1, 0, ""),
                 cell(number(link, "voices_out_per_s"), 1, 0, ""),
                 cell(number(link, "last_heard_s"), 1, 1, " s"),
                 cell(number(link, "age_s"), 1, 0, " s"), text(link, "peer"), key_expiry(link));
}

void add_guests(const json& rooms, std::string& out) {
  fmt::format_to(std::back_inserter(out),
                 "\n{:<17}{:<21}{:<17}{:>10}{:>10}{:>8}{:>8}{:>10}{:>10}{:>8}{:>8}{:>8}{:>9}  {}\n",
                 "guest", "shown as", "room", "rtt", "jitter", "lost up", "down", "in/s", "out/s",
                 "speaks", "hears", "heard", "here", "from");
  each(rooms, [&](const json& room) {
    each(member(room, "links"), [&](const json& link) {
      const json& guests = member(link, "guests");
      if (guests.empty()) add_line({"(listens)", "", std::nullopt}, text(room, "name"), link, out);
      each(guests, [&](const json& guest) {
        add_line({text(guest, "name"), shown_text(guest, "shown_name"), number(guest, "jitter_ms")},
                 text(room, "name"), link, out);
      });
    });
  });
}

// The server sorts them: the most used key comes first.
void add_keys(const json& keys, std::string& out) {
  if (keys.empty()) return;
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "\n{:<25}{:>9}{:>7}{:>10}{:>10}{:>10}\n", "key", "sessions", "rooms", "in/s",
                 "out/s", "avatars");
  each(keys, [&](const json& key) {
    fmt::format_to(back, "{:<25}{:>9}{:>7}{:>10}{:>10}{:>10}\n", text(key, "name"),
                   cell(number(key, "sessions"), 1, 0, ""), cell(number(key, "rooms"), 1, 0, ""),
                   cell(number(key, "bytes_in_per_s"), 1e-3, 1, " kB"),
                   cell(number(key, "bytes_out_per_s"), 1e-3, 1, " kB"),
                   cell(number(key, "avatar_bytes"), 1e-6, 1, " MB"));
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
    add_keys(member(status, "keys"), out);
  }
  add_causes("dropped", member(status, "rejects"), out);
  add_causes("handshakes", member(status, "handshakes"), out);
  return out;
}

}  // namespace dance
