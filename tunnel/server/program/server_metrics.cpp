#include "tunnel/server/program/server_metrics.h"

#include <prometheus/collectable.h>
#include <prometheus/exposer.h>
#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <exception>
#include <mutex>
#include <sstream>
#include <utility>

#include "core/net/tcp_socket.h"

namespace dance {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

class Page {
 public:
  // The values that follow are of this metric.
  void begin(const char* name, MetricType type, const char* help) {
    families_.push_back({std::string("dance_server_") + name, help, type, {}});
  }
  void add(double value, Labels labels = {}) {
    ClientMetric metric;
    metric.label = std::move(labels);
    if (families_.back().type == MetricType::Counter)
      metric.counter.value = value;
    else
      metric.gauge.value = value;
    families_.back().metric.push_back(std::move(metric));
  }
  void gauge(const char* name, const char* help, double value) {
    begin(name, MetricType::Gauge, help);
    add(value);
  }
  void counter(const char* name, const char* help, std::uint64_t value) {
    begin(name, MetricType::Counter, help);
    add(static_cast<double>(value));
  }
  void counters(const char* name, const char* help, const std::vector<NamedCount>& counts) {
    begin(name, MetricType::Counter, help);
    for (const NamedCount& count : counts)
      add(static_cast<double>(count.count), {{"cause", count.name}});
  }
  // A metric without values is left out.
  std::vector<MetricFamily> take() {
    std::erase_if(families_, [](const auto& family) { return family.metric.empty(); });
    return std::move(families_);
  }

 private:
  std::vector<MetricFamily> families_;
};

void add_totals(const ServerStatus& status, Page& page) {
  const ServerCounters& c = status.totals;
  page.begin("build_info", MetricType::Gauge, "Always 1; the version stands in the label.");
  page.add(1.0, {{"version", status.version}});
  page.gauge("uptime_seconds", "Since the server began.", status.uptime.as_seconds());
  std::size_t links = 0, guests = 0;
  for (const ServerRoomStatus& room : status.rooms) {
    links += room.links.size();
    guests += room.guests;
  }
  page.gauge("rooms", "Rooms with somebody in them.", static_cast<double>(status.rooms.size()));
  page.gauge("links", "Links of houses, those that only listen too.", static_cast<double>(links));
  page.gauge("guests", "Guests in all rooms.", static_cast<double>(guests));
  page.counter("datagrams_received_total", "Datagrams taken in.", c.datagrams_in);
  page.counter("datagrams_sent_total", "Datagrams sent.", c.datagrams_out);
  page.counter("received_bytes_total", "Bytes of datagrams taken in.", c.bytes_in);
  page.counter("sent_bytes_total", "Bytes of datagrams sent.", c.bytes_out);
  page.counter("records_received_total", "Poses and hands that were taken.", c.records_in);
  page.counter("records_sent_total", "Poses and hands sent on, once for each receiver.",
               c.records_out);
  page.counter("voices_received_total", "Packets of voices, 10 ms each, that were taken.",
               c.voices_in);
  page.counter("voices_sent_total", "Packets of voices sent on, once for each receiver.",
               c.voices_out);
  page.counter("voice_sent_bytes_total", "Bytes of datagrams with voices, of all sent.",
               c.voice_bytes_out);
  page.counters("voices_left_out_total", "Packets of voices not sent to who wants them.",
                {{"crowded", c.voices_crowded}, {"narrow_line", c.voices_held_back}});
  page.counter("key_frames_asked_total", "Intra frames asked of guests.", c.intra_frames_asked);
  page.counter("sessions_begun_total", "Links that came.", c.sessions_begun);
  page.counter("sessions_resumed_total", "Links that came back from elsewhere.",
               c.sessions_resumed);
  page.counter("sessions_timed_out_total", "Links that fell silent.", c.sessions_timed_out);
  page.counter("sessions_removed_total", "Links whose guests a host removed.", c.sessions_removed);
  page.counter("goodbyes_total", "Links that said goodbye.", c.goodbyes);
  page.counters("rejected_total", "Datagrams, or records in them, that went no further.",
                status.rejects);
  page.counters("handshakes_total", "Handshakes by how they ended.", status.handshakes);
}

template <class Value>
void add_rooms(const ServerStatus& status, Page& page, Value value) {
  for (const ServerRoomStatus& room : status.rooms)
    page.add(value(room), {{"room", std::string(room.name.view())}});
}

// A link is named by its first guest; links that only listen have no name that could stay theirs.
template <class Value>
void add_links(const ServerStatus& status, Page& page, Value value) {
  for (const ServerRoomStatus& room : status.rooms)
    for (const ServerLinkStatus& link : room.links) {
      if (link.guests.empty()) continue;
      if (const std::optional<double> number = value(link))
        page.add(*number, {{"room", std::string(room.name.view())},
                           {"guest", std::string(link.guests[0].id.view())}});
    }
}

template <class Value>
void add_guests(const ServerStatus& status, Page& page, Value value) {
  for (const ServerRoomStatus& room : status.rooms)
    for (const ServerLinkStatus& link : room.links)
      for (const ServerGuestStatus& guest : link.guests)
        if (const std::optional<double> number = value(guest))
          page.add(*number, {{"room", std::string(room.name.view())},
                             {"guest", std::string(guest.id.view())}});
}

std::optional<double> seconds_of(const std::optional<Duration>& duration) {
  return duration ? std::optional(duration->as_seconds()) : std::nullopt;
}

void add_parts(const ServerStatus& status, Page& page) {
  using Room = ServerRoomStatus;
  using OfLink = ServerLinkStatus;
  using OfGuest = ServerGuestStatus;
  constexpr MetricType kGauge = MetricType::Gauge;
  constexpr MetricType kCounter = MetricType::Counter;
  using Number = std::optional<double>;
  page.begin("room_guests", kGauge, "Guests in a room.");
  add_rooms(status, page, [](const Room& room) { return static_cast<double>(room.guests); });
  page.begin("room_listeners", kGauge, "Links of a room that only listen.");
  add_rooms(status, page, [](const Room& room) { return static_cast<double>(room.listeners); });
  page.begin("room_share_window_seconds", kGauge,
             "How long a pose waits for others to share a datagram with.");
  add_rooms(status, page, [](const Room& room) { return room.share_window.as_seconds(); });

  page.begin("link_round_trip_seconds", kGauge, "As the link's newest ping says.");
  add_links(status, page, [](const OfLink& link) { return seconds_of(link.round_trip); });
  page.begin("link_loss_up_ratio", kGauge, "Share of the link's poses that did not come.");
  add_links(status, page, [](const OfLink& link) { return link.loss_up; });
  page.begin("link_loss_down_ratio", kGauge,
             "Share of the others' poses that the link did not get, as its pings say.");
  add_links(status, page, [](const OfLink& link) { return link.loss_down; });
  page.begin("link_last_heard_seconds", kGauge, "Since the link's newest datagram.");
  add_links(status, page, [](const OfLink& link) { return Number(link.last_heard.as_seconds()); });
  page.begin("link_received_bytes_total", kCounter, "Bytes from the link in this session.");
  add_links(status, page,
            [](const OfLink& link) { return Number(static_cast<double>(link.bytes_in)); });
  page.begin("link_sent_bytes_total", kCounter, "Bytes to the link in this session.");
  add_links(status, page,
            [](const OfLink& link) { return Number(static_cast<double>(link.bytes_out)); });

  page.begin("guest_jitter_seconds", kGauge, "Interarrival jitter of the guest's poses, RFC 3550.");
  add_guests(status, page, [](const OfGuest& guest) { return seconds_of(guest.jitter); });
  page.begin("guest_poses_total", kCounter, "Poses of the guest that went on.");
  add_guests(status, page,
             [](const OfGuest& guest) { return Number(static_cast<double>(guest.poses)); });
  page.begin("guest_voices_total", kCounter, "Packets of the guest's voice that were taken.");
  add_guests(status, page,
             [](const OfGuest& guest) { return Number(static_cast<double>(guest.voices)); });
  page.begin("guest_voice_bytes_total", kCounter, "Bytes of these packets.");
  add_guests(status, page,
             [](const OfGuest& guest) { return Number(static_cast<double>(guest.voice_bytes)); });
  // What comes late after all is taken off again, so this is no counter.
  page.begin("guest_poses_lost", kGauge, "Poses of the guest that did not come until now.");
  add_guests(status, page,
             [](const OfGuest& guest) { return Number(static_cast<double>(guest.lost)); });
}

template <class Value>
void add_peers(const ClusterStatus& cluster, Page& page, Value value) {
  for (const ClusterPeerStatus& peer : cluster.peers)
    if (const std::optional<double> number = value(peer))
      page.add(*number, {{"server", server_id_text(peer.id)}, {"address", peer.address}});
}

template <class Value>
void add_between(const ClusterStatus& cluster, Page& page, Value value) {
  for (const ClusterLinkStatus& link : cluster.between)
    if (const std::optional<double> number = value(link))
      page.add(*number,
               {{"room", std::string(link.room.view())}, {"server", server_id_text(link.peer)}});
}

void add_cluster_totals(const ClusterStatus& cluster, Page& page) {
  const ClusterNode::Counters& node = cluster.node;
  page.gauge("cluster_nats_connected", "1 where NATS answers, else 0.",
             cluster.nats.is_connected ? 1.0 : 0.0);
  page.counter("cluster_nats_reconnects_total", "Times that NATS came back.",
               cluster.nats.reconnects);
  page.counter("cluster_nats_dropped_received_total",
               "Messages from NATS that this server was too slow for.", cluster.nats.dropped_in);
  page.counter("cluster_nats_dropped_sent_total",
               "Messages that NATS did not take, or that found no connection.",
               cluster.nats.dropped_out);
  page.counter("cluster_nats_failed_values_total", "Values that had to be written once more.",
               cluster.nats.failed_values);
  page.gauge("cluster_nats_unwritten_values", "Values that wait to be written.",
             static_cast<double>(cluster.nats.unwritten_values));
  page.gauge("cluster_keys", "Keys of the cluster's bucket.", static_cast<double>(cluster.keys));
  page.gauge("cluster_clock_offset_seconds", "The cluster's clock less this process's.",
             cluster.clock_offset.as_seconds());
  page.counter("cluster_clock_steps_total", "Jumps of the cluster's clock here.",
               cluster.clock_steps);
  page.counter("cluster_messages_received_total", "Messages of other servers.", node.messages_in);
  page.counter("cluster_messages_sent_total", "Messages to other servers.", node.messages_out);
  page.counter("cluster_received_bytes_total", "Bytes of these messages, without NATS's own.",
               node.bytes_in);
  page.counter("cluster_sent_bytes_total", "Bytes of these messages, without NATS's own.",
               node.bytes_out);
  page.counter("cluster_records_received_total", "Poses and hands from other servers.",
               node.records_in);
  page.counter("cluster_records_sent_total",
               "Poses and hands published, once for all servers that take them.", node.records_out);
  page.counter("cluster_voices_received_total", "Packets of voices from other servers.",
               node.voices_in);
  page.counter("cluster_voices_sent_total",
               "Packets of voices published, once for all servers that take them.",
               node.voices_out);
  page.counter("cluster_malformed_total", "Messages and values that were none.", node.malformed);
  page.counter("cluster_deaths_total", "Times that another server fell silent.", cluster.deaths);
}

void add_cluster(const ClusterStatus& cluster, Page& page) {
  using Peer = ClusterPeerStatus;
  using Between = ClusterLinkStatus;
  constexpr MetricType kGauge = MetricType::Gauge;
  constexpr MetricType kCounter = MetricType::Counter;
  using Number = std::optional<double>;
  add_cluster_totals(cluster, page);
  page.begin("cluster_server_alive", kGauge, "1 where that server beats, else 0.");
  add_peers(cluster, page, [](const Peer& peer) { return Number(peer.is_alive ? 1.0 : 0.0); });
  page.begin("cluster_server_last_heard_seconds", kGauge, "Since that server's newest beat.");
  add_peers(cluster, page, [](const Peer& peer) { return Number(peer.last_heard.as_seconds()); });
  page.begin("cluster_server_round_trip_seconds", kGauge, "To that server and back, through NATS.");
  add_peers(cluster, page, [](const Peer& peer) { return seconds_of(peer.round_trip); });
  page.begin("cluster_server_links", kGauge, "Links of that server.");
  add_peers(cluster, page, [](const Peer& peer) { return Number(peer.links); });
  page.begin("cluster_server_guests", kGauge, "Guests that came through that server.");
  add_peers(cluster, page, [](const Peer& peer) { return Number(peer.guests); });
  const auto counter = [&](const char* name, const char* help, auto value) {
    page.begin(name, kCounter, help);
    add_between(cluster, page,
                [&](const Between& link) { return Number(static_cast<double>(value(link))); });
  };
  counter("cluster_room_records_received_total", "Poses and hands of the room from that server.",
          [](const Between& link) { return link.meter.records_in; });
  counter("cluster_room_records_sent_total",
          "Poses and hands of the room published while that server takes them.",
          [](const Between& link) { return link.meter.records_out; });
  counter("cluster_room_feedback_received_total", "Guests that its feedback spoke of.",
          [](const Between& link) { return link.meter.feedback_in; });
  counter("cluster_room_feedback_sent_total", "Guests that feedback to it spoke of.",
          [](const Between& link) { return link.meter.feedback_out; });
  page.begin("cluster_room_poses_lost", kGauge,
             "Poses of its guests there that did not come here until now.");
  add_between(cluster, page,
              [](const Between& link) { return Number(static_cast<double>(link.poses_lost)); });
}

std::vector<MetricFamily> families_of(const ServerStatus& status) {
  Page page;
  add_totals(status, page);
  add_parts(status, page);
  if (status.cluster) add_cluster(*status.cluster, page);
  return page.take();
}

class Newest final : public prometheus::Collectable {
 public:
  void show(std::shared_ptr<const ServerStatus> status) {
    const std::lock_guard lock(mutex_);
    status_.swap(status);
  }  // what was shown before goes after the lock
  std::vector<MetricFamily> Collect() const override {
    std::shared_ptr<const ServerStatus> status;
    {
      const std::lock_guard lock(mutex_);
      status = status_;
    }
    return status ? families_of(*status) : std::vector<MetricFamily>();
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ServerStatus> status_;
};

class Exposed final : public ServerMetrics {
 public:
  // Throws what the exposer throws.
  explicit Exposed(const Address& address)
      : exposer_(std::vector<std::string>{"listening_ports", address.to_string(), "num_threads",
                                          "2", "request_timeout_ms", "5000"}) {
    exposer_.RegisterCollectable(newest_);
  }
  void show(ServerStatus status) override {
    newest_->show(std::make_shared<const ServerStatus>(std::move(status)));
  }
  std::uint16_t port() const override {
    return static_cast<std::uint16_t>(exposer_.GetListeningPorts().at(0));
  }

 private:
  std::shared_ptr<Newest> newest_ = std::make_shared<Newest>();
  prometheus::Exposer exposer_;
};

}  // namespace

bool ServerMetrics::is_built() { return true; }

Result<std::unique_ptr<ServerMetrics>> ServerMetrics::open(const Address& address) {
  try {
    return std::unique_ptr<ServerMetrics>(std::make_unique<Exposed>(address));
  } catch (const std::exception&) {  // The library gives no reason.
    const std::string option = "--metrics " + address.to_string() + ": ";
    if (const auto can = try_tcp_port(address); !can) return fail(option + can.error().what);
    if (address.family() == Address::Family::kIpv6)
      return fail(option + "the web server of this build (civetweb) has no IPv6; use 127.0.0.1:" +
                  std::to_string(address.port()));
    return fail(option + "the web server of this build (civetweb) does not start");
  }
}

std::string metrics_text(const ServerStatus& status) {
  std::ostringstream text;
  prometheus::TextSerializer().Serialize(text, families_of(status));
  return text.str();
}

}  // namespace dance
