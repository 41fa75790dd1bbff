#include <enet/enet.h>

#include <vector>

#include "bench/parts/float_pose.h"
#include "bench/tunnel/crowd.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

// What ENet does by the clock: acknowledgements, pings.
constexpr Duration kHousekeeping = Duration::ms(5);

bool is_ready() {
  static const bool ready = enet_initialize() == 0;
  return ready;
}

// Never drops because the round trip varies, which its throttle is for.
void keep_all(ENetPeer* peer) {
  enet_peer_throttle_configure(peer, ENET_PEER_PACKET_THROTTLE_INTERVAL,
                               ENET_PEER_PACKET_THROTTLE_SCALE, 0);
}

class EnetCrowd final : public Crowd {
 public:
  EnetCrowd(const CrowdOptions& options, Poller& poller) : options_(options), poller_(poller) {}
  ~EnetCrowd() override {
    for (const Guest& guest : guests_) {
      poller_.unwatch(guest.host->socket);
      enet_host_destroy(guest.host);
    }
  }
  Result<void> open() {
    if (!is_ready()) return fail("ENet cannot begin");
    ENetAddress address{};
    address.port = options_.relay.port();
    if (enet_address_set_host_ip(&address, "127.0.0.1") != 0) return fail("ENet has no loopback");
    for (std::size_t i = 0; i < options_.guests; ++i) {
      ENetHost* host = enet_host_create(nullptr, 1, 1, 0, 0);
      if (host == nullptr) return fail("ENet cannot open a socket");
      ENetPeer* peer = enet_host_connect(host, &address, 1, 0);
      guests_.push_back({host, peer, false});
      poller_.watch(host->socket, [this, i](MonoTime) { turn(i); });
    }
    poller_.add_timer(mono_now() + kHousekeeping, [this](MonoTime now) {
      for (std::size_t i = 0; i < guests_.size(); ++i) turn(i);
      return now + kHousekeeping;
    });
    return {};
  }
  bool is_open() override {
    for (const Guest& guest : guests_)
      if (!guest.is_connected) return false;
    return true;
  }
  void send(std::size_t guest, const Pose& pose, MonoTime) override {
    const FloatPose raw = float_pose(guest, pose);
    ENetPacket* packet = enet_packet_create(&raw, sizeof raw, ENET_PACKET_FLAG_UNSEQUENCED);
    if (enet_peer_send(guests_[guest].peer, 0, packet) != 0) enet_packet_destroy(packet);
    enet_host_flush(guests_[guest].host);
  }
  Traffic traffic() const override {
    Traffic sum;
    sum.poses_down = poses_heard_;
    sum.payload_down = poses_heard_ * sizeof(FloatPose);
    for (const Guest& guest : guests_) {
      sum.bytes_up += guest.host->totalSentData + kIpUdp_bytes * guest.host->totalSentPackets;
      sum.bytes_down +=
          guest.host->totalReceivedData + kIpUdp_bytes * guest.host->totalReceivedPackets;
    }
    return sum;
  }

 private:
  struct Guest {
    ENetHost* host;
    ENetPeer* peer;
    bool is_connected;
  };
  void turn(std::size_t listener) {
    Guest& guest = guests_[listener];
    ENetEvent event;
    while (enet_host_service(guest.host, &event, 0) > 0) {
      if (event.type == ENET_EVENT_TYPE_CONNECT) {
        guest.is_connected = true;
        keep_all(guest.peer);
      }
      if (event.type != ENET_EVENT_TYPE_RECEIVE) continue;
      FloatPose raw;
      if (read_float_pose({event.packet->data, event.packet->dataLength}, raw, pose_)) {
        ++poses_heard_;
        options_.heard(listener, raw.sender, raw.sequence);
      }
      enet_packet_destroy(event.packet);
    }
  }

  CrowdOptions options_;
  Poller& poller_;
  std::vector<Guest> guests_;
  std::uint64_t poses_heard_ = 0;
  Pose pose_;
};

}  // namespace

Result<std::unique_ptr<Crowd>> open_enet_crowd(const CrowdOptions& options, Poller& poller) {
  auto crowd = std::make_unique<EnetCrowd>(options, poller);
  if (auto opened = crowd->open(); !opened) return tl::make_unexpected(opened.error());
  return crowd;
}

Error relay_enet(std::uint16_t port) {
  if (!is_ready()) return {"ENet cannot begin"};
  ENetAddress address{};
  address.port = port;
  enet_address_set_host_ip(&address, "127.0.0.1");
  ENetHost* host = enet_host_create(&address, 64, 1, 0, 0);
  if (host == nullptr) return {"ENet cannot have port " + std::to_string(port)};
  ENetEvent event;
  for (;;) {
    // Sleeps until something comes; then takes all that is there before it sends.
    for (int more = enet_host_service(host, &event, 100); more > 0;
         more = enet_host_check_events(host, &event)) {
      if (event.type == ENET_EVENT_TYPE_CONNECT) keep_all(event.peer);
      if (event.type != ENET_EVENT_TYPE_RECEIVE) continue;
      ENetPacket* copy = enet_packet_create(event.packet->data, event.packet->dataLength,
                                            ENET_PACKET_FLAG_UNSEQUENCED);
      for (std::size_t i = 0; i < host->peerCount; ++i) {
        ENetPeer* peer = &host->peers[i];
        if (peer != event.peer && peer->state == ENET_PEER_STATE_CONNECTED)
          enet_peer_send(peer, 0, copy);
      }
      if (copy->referenceCount == 0) enet_packet_destroy(copy);
      enet_packet_destroy(event.packet);
    }
    enet_host_flush(host);
  }
}

}  // namespace dance
