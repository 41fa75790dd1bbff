// The tables of `dance status`, and whose a port is, from texts as a server and the kernel give
// them.
#include <gtest/gtest.h>

#include "apps/status/cluster_table.h"
#include "apps/status/status_source.h"
#include "apps/status/status_table.h"

namespace dance {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson some_status() {
  return OrderedJson::parse(R"({"version": "9.9", "address": "127.0.0.1:7400", "uptime_s": 61.4,
    "rooms": [{"name": "salsa", "guests": 2, "listeners": 1, "codec": "lattice",
      "share_window_ms": 0.25, "links": [
      {"peer": "10.0.0.7:999", "age_s": 60.2, "last_heard_s": 0.012, "round_trip_ms": 42.5,
       "loss_up": 0.125, "loss_down": null, "bytes_in_per_s": 12345, "bytes_out_per_s": 500,
       "voices_in_per_s": 99.6, "voices_out_per_s": 731,
       "guests": [{"name": "alice", "shown_name": "Alicia L\u00f3pez", "jitter_ms": 1.75},
                  {"name": "anna", "jitter_ms": null}]},
      {"peer": "10.0.0.8:999", "round_trip_ms": null, "guests": []}]}],
    "keys": [{"name": "alice-key", "sessions": 2, "rooms": 1, "bytes_in_per_s": 7300,
      "bytes_out_per_s": 7700, "avatar_bytes": 2500000}],
    "rejects": {"malformed": 0, "late": 3}, "handshakes": {"unknown_key": 2, "done": 0}})");
}

TEST(StatusTable, TellsRoomsGuestsAndWhatWasRefused) {
  const std::string text = status_text(some_status());
  for (const char* words : {"dance server 9.9 on 127.0.0.1:7400, up 61 s",
                            "salsa",
                            "lattice",
                            "0.25 ms",
                            "alice            Alicia L\u00f3pez",
                            "anna             -",
                            "(listens)",
                            "42.50 ms",
                            "1.75 ms",
                            "12.5%",
                            "12.3 kB",
                            "0.5 kB",
                            "speaks",
                            " 100 ",
                            " 731 ",
                            "alice-key",
                            "7.7 kB",
                            "2.5 MB",
                            "10.0.0.7:999",
                            "10.0.0.8:999",
                            "\ndropped:  late 3\n",
                            "\nhandshakes:  unknown_key 2\n"})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  EXPECT_EQ(text.find("malformed"), std::string::npos) << "what did not happen is left out";
  EXPECT_EQ(text.find("done"), std::string::npos);
}

TEST(StatusTable, ReplacesControlCharactersOfShownNames) {
  OrderedJson status = some_status();
  status["rooms"][0]["links"][0]["guests"][0]["shown_name"] = "A\x1b[2J\u202e\xff";
  EXPECT_NE(status_text(status).find("A?[2J??"), std::string::npos);
}

TEST(StatusTable, AnEmptyServerSaysSo) {
  const std::string text =
      status_text(OrderedJson{{"version", "1"}, {"rooms", OrderedJson::array()}});
  EXPECT_NE(text.find("(nobody is here)"), std::string::npos);
  EXPECT_EQ(text.find("dropped"), std::string::npos);
}

TEST(StatusTable, WhateverTheServerTellsItIsATable) {
  // Each value by something of another kind.
  const OrderedJson good = some_status().flatten();
  for (const auto& [path, value] : good.items())
    for (const OrderedJson& other : {OrderedJson(), OrderedJson(-1e300), OrderedJson("\033[2J\n"),
                                     OrderedJson::array({1, OrderedJson::array()}),
                                     OrderedJson::object(), OrderedJson(true)}) {
      OrderedJson changed = some_status();
      changed[OrderedJson::json_pointer(path)] = other;
      const std::string text = status_text(changed);
      EXPECT_EQ(text.find('\033'), std::string::npos) << path;
    }
  for (const OrderedJson& other :
       {OrderedJson(), OrderedJson(1), OrderedJson("x"), OrderedJson::array()})
    status_text(other);
}

OrderedJson some_cluster() {
  return OrderedJson::parse(
      R"({"cluster": {"id": "aaaaaaaa00000001", "clock_server": "bbbbbbbb00000002",
    "clock_offset_ms": -12.4, "links": 3, "guests": 4, "keys": 7,
    "nats": {"connected": true, "reconnects": 2, "dropped_in": 0, "dropped_out": 9,
      "unwritten_values": 0}, "nats_keys": {"connected": false},
    "servers": [{"id": "bbbbbbbb00000002", "address": "192.0.2.7:7400", "alive": true,
      "leads_clock": true, "last_heard_s": 0.11, "round_trip_ms": 1.25, "links": 5, "guests": 6},
      {"id": "cccccccc00000003", "alive": false}],
    "between": [{"room": "salsa", "server": "bbbbbbbb00000002", "guests": 2, "records_in": 1234,
      "records_out": 5678, "feedback_in": 91, "feedback_out": 92, "poses_lost": 3,
      "poses_late": 4}],
    "totals": {"malformed": 0, "deaths": 1}}})");
}

TEST(ClusterTable, TellsNatsServersAndWhatPassesBetweenThem) {
  const std::string text = cluster_text(some_cluster());
  for (const char* words :
       {"NATS: connected yes, came back 2, dropped 0 in and 9 out, unwritten 0\n",
        "NATS for keys: connected no", "keys of the cluster: 7", "aaaaaaaa  this one", "-12 ms",
        "bbbbbbbb  alive", "1.25 ms", "leads", "192.0.2.7:7400", "cccccccc  gone", "salsa", "1234",
        "5678", "deaths 1"})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  EXPECT_EQ(text.find("malformed"), std::string::npos);
}

TEST(ClusterTable, WhateverTheServerTellsItIsATable) {
  const OrderedJson good = some_cluster().flatten();
  for (const auto& [path, value] : good.items())
    for (const OrderedJson& other :
         {OrderedJson(), OrderedJson(-1e300), OrderedJson("\033[2J\n"), OrderedJson::array({1}),
          OrderedJson::object(), OrderedJson(true)}) {
      OrderedJson changed = some_cluster();
      changed[OrderedJson::json_pointer(path)] = other;
      EXPECT_EQ(cluster_text(changed).find('\033'), std::string::npos) << path;
    }
  for (const OrderedJson& other : {OrderedJson(), OrderedJson(1), OrderedJson{{"cluster", 1}}})
    cluster_text(other);
}

TEST(StatusSource, FindsTheOwnerOfAPort) {
  const std::string table =
      "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
      "inode ref pointer drops\n"
      "  421: 0100007F:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000        0 "
      "29385 2 0000000000000000 0\n"
      "  422: 00000000:0044 0100007F:1CE9 07 00000000:00000000 00:00000000 00000000     0        0 "
      "29386 2 0000000000000000 0\n"
      "  423: 00000000000000000000000000000000:1CEA 00000000000000000000000000000000:0000 07 "
      "00000000:00000000 00:00000000 00000000    33        0 29387 2 0000000000000000 0\n";
  EXPECT_EQ(owner_of_udp_port(table, 7400), 1000u);
  EXPECT_EQ(owner_of_udp_port(table, 68), 0u);
  EXPECT_EQ(owner_of_udp_port(table, 7401), std::nullopt) << "that is the other end's";
  EXPECT_EQ(owner_of_udp_port(table, 7402), 33u);
  EXPECT_EQ(owner_of_udp_port("", 7400), std::nullopt);
  for (std::size_t i = 0; i < table.size(); ++i) owner_of_udp_port(table.substr(0, i), 7400);
}

}  // namespace
}  // namespace dance
