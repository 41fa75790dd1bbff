#include "apps/status/cluster_table.h"

#include <fmt/format.h>

#include <iterator>

#include "apps/status/status_json.h"

namespace dance {
namespace {

using namespace status_json;

// Enough to tell servers apart.
std::string short_id(const json& object, const char* key) { return text(object, key).substr(0, 8); }

std::string yes_or_no(const json& object, const char* key) {
  const json& value = member(object, key);
  return !value.is_boolean() ? "-" : value.get<bool>() ? "yes" : "no";
}

void add_bus_line(const char* title, const json& bus, std::string& out) {
  fmt::format_to(std::back_inserter(out),
                 "{}: connected {}, came back {}, dropped {} in and {} out, unwritten {}\n", title,
                 yes_or_no(bus, "connected"), cell(number(bus, "reconnects"), 1, 0, ""),
                 cell(number(bus, "dropped_in"), 1, 0, ""),
                 cell(number(bus, "dropped_out"), 1, 0, ""),
                 cell(number(bus, "unwritten_values"), 1, 0, ""));
}

void add_server(const std::string& id, const json& server, const std::string& state,
                const std::string& clock, std::string& out) {
  fmt::format_to(std::back_inserter(out), "{:<10}{:<9}{:>10}{:>7}{:>8}{:>10}  {:<8}{}\n", id, state,
                 cell(number(server, "round_trip_ms"), 1, 2, " ms"),
                 cell(number(server, "links"), 1, 0, ""), cell(number(server, "guests"), 1, 0, ""),
                 cell(number(server, "last_heard_s"), 1, 1, " s"), clock, text(server, "address"));
}

void add_servers(const json& cluster, std::string& out) {
  fmt::format_to(std::back_inserter(out), "\n{:<10}{:<9}{:>10}{:>7}{:>8}{:>10}  {:<8}{}\n",
                 "server", "state", "rtt", "links", "guests", "heard", "clock", "address");
  const bool leads = text(cluster, "clock_server") == text(cluster, "id");
  add_server(short_id(cluster, "id"), cluster, "this one",
             leads ? "leads" : cell(number(cluster, "clock_offset_ms"), 1, 0, " ms"), out);
  each(member(cluster, "servers"), [&](const json& server) {
    add_server(short_id(server, "id"), server,
               yes_or_no(server, "alive") == "yes" ? "alive" : "gone",
               yes_or_no(server, "leads_clock") == "yes" ? "leads" : "", out);
  });
}

void add_between(const json& between, std::string& out) {
  if (!between.is_array() || between.empty()) return;
  fmt::format_to(std::back_inserter(out), "\n{:<25}{:<10}{:>7}{:>12}{:>12}{:>8}{:>8}{:>11}{:>10}\n",
                 "room", "server", "guests", "records in", "out", "lost", "late", "feedback in",
                 "out");
  each(between, [&](const json& link) {
    fmt::format_to(
        std::back_inserter(out), "{:<25}{:<10}{:>7}{:>12}{:>12}{:>8}{:>8}{:>11}{:>10}\n",
        text(link, "room"), short_id(link, "server"), cell(number(link, "guests"), 1, 0, ""),
        cell(number(link, "records_in"), 1, 0, ""), cell(number(link, "records_out"), 1, 0, ""),
        cell(number(link, "poses_lost"), 1, 0, ""), cell(number(link, "poses_late"), 1, 0, ""),
        cell(number(link, "feedback_in"), 1, 0, ""), cell(number(link, "feedback_out"), 1, 0, ""));
  });
}

}  // namespace

std::string cluster_text(const json& status) {
  const json& cluster = member(status, "cluster");
  std::string out = "\n";
  add_bus_line("NATS", member(cluster, "nats"), out);
  add_bus_line("NATS for keys", member(cluster, "nats_keys"), out);
  out += "keys of the cluster: " + cell(number(cluster, "keys"), 1, 0, "") + "\n";
  add_servers(cluster, out);
  add_between(member(cluster, "between"), out);
  add_causes("between servers", member(cluster, "totals"), out);
  return out;
}

}  // namespace dance
