#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "bench/parts/float_pose.h"
#include "bench/tunnel/crowd.h"
#include "core/net/udp_socket.h"

namespace dance {
namespace {

class UdpCrowd final : public Crowd {
 public:
  explicit UdpCrowd(const CrowdOptions& options, Poller& poller)
      : options_(options), poller_(poller) {}
  ~UdpCrowd() override {
    for (const UdpSocket& socket : sockets_) poller_.unwatch(socket.fd());
  }
  Result<void> open() {
    for (std::size_t i = 0; i < options_.guests; ++i) {
      DANCE_TRY(UdpSocket socket, UdpSocket::connect(options_.relay));
      sockets_.push_back(std::move(socket));
    }
    for (std::size_t i = 0; i < options_.guests; ++i)
      poller_.watch(sockets_[i].fd(), [this, i](MonoTime) { hear(i); });
    return {};
  }
  // The relay knows who has said something; it says nothing itself.
  bool is_open() override {
    const std::uint8_t hello = 0;
    for (UdpSocket& socket : sockets_) socket.send_now(options_.relay, {&hello, 1});
    return heard_.size() == options_.guests;
  }
  void send(std::size_t guest, const Pose& pose, MonoTime) override {
    const FloatPose raw = float_pose(guest, pose);
    sockets_[guest].send_now(options_.relay,
                             {reinterpret_cast<const std::uint8_t*>(&raw), sizeof raw});
  }
  Traffic traffic() const override {
    Traffic sum;
    sum.poses_down = poses_heard_;
    sum.payload_down = poses_heard_ * sizeof(FloatPose);
    for (const UdpSocket& socket : sockets_) {
      sum.bytes_up += socket.counters().sent_bytes + kIpUdp_bytes * socket.counters().sent;
      sum.bytes_down +=
          socket.counters().received_bytes + kIpUdp_bytes * socket.counters().received;
    }
    return sum;
  }

 private:
  void hear(std::size_t listener) {
    for (auto batch = sockets_[listener].receive(); !batch.empty();
         batch = sockets_[listener].receive()) {
      for (const UdpSocket::Datagram& datagram : batch) {
        FloatPose raw;
        if (datagram.bytes.size() == 1) note(listener);
        if (!read_float_pose(datagram.bytes, raw, pose_)) continue;
        ++poses_heard_;
        options_.heard(listener, raw.sender, raw.sequence);
      }
      if (batch.size() < UdpSocket::kBatch) return;
    }
  }
  void note(std::size_t listener) {
    for (const std::size_t who : heard_)
      if (who == listener) return;
    heard_.push_back(listener);
  }

  CrowdOptions options_;
  Poller& poller_;
  std::vector<UdpSocket> sockets_;
  std::vector<std::size_t> heard_;
  std::uint64_t poses_heard_ = 0;
  Pose pose_;
};

Error failure(const char* call) {
  std::array<char, 128> text{};
  return {std::string("bare relay's ") + call + ": " + strerror_r(errno, text.data(), text.size())};
}

}  // namespace

Result<std::unique_ptr<Crowd>> open_udp_crowd(const CrowdOptions& options, Poller& poller) {
  auto crowd = std::make_unique<UdpCrowd>(options, poller);
  if (auto opened = crowd->open(); !opened) return tl::make_unexpected(opened.error());
  return crowd;
}

Error relay_udp(std::uint16_t port) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  own.sin_port = htons(port);
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
    return failure("socket");
  const int bytes = 1 << 22;
  if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0)
    setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  std::vector<sockaddr_in> guests;
  std::array<std::uint8_t, 2048> datagram;
  for (;;) {
    sockaddr_in from{};
    socklen_t from_size = sizeof from;
    const ssize_t size = recvfrom(fd, datagram.data(), datagram.size(), 0,
                                  reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0 && errno != EINTR && errno != ECONNREFUSED) return failure("recvfrom");
    if (size <= 0) continue;
    bool is_known = false;
    for (const sockaddr_in& guest : guests) {
      if (guest.sin_port == from.sin_port)
        is_known = true;
      else
        sendto(fd, datagram.data(), static_cast<std::size_t>(size), 0,
               reinterpret_cast<const sockaddr*>(&guest), sizeof guest);
    }
    if (!is_known) guests.push_back(from);
  }
}

}  // namespace dance
