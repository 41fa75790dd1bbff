// RokokoReceiver: takes a dancer out of the live stream of Rokoko Studio (JSON v3, plain or in LZ4
// frames): the actor of a name, or the first with a body.
//
// Units/frames: captures in W; capture times from the stream's timestamps in this house's clock.
// Ownership:    owns its socket; refers to sink and poller.
// Threads:      none inside; runs in the poller's thread.
// Failure:      open() names the address and the cure; what cannot be used is dropped and counted
//               by cause.
#pragma once

#include <array>
#include <memory>

#include "core/net/one_way_clock.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "formats/rokoko/rokoko_reader.h"
#include "producers/receive/joint_figure.h"
#include "producers/receive/one_sender.h"
#include "producers/receive/pose_receiver.h"
#include "producers/receive/received_dancer.h"

namespace dance {

class RokokoReceiver final : public PoseReceiver {
 public:
  static constexpr const char* kUsualAddress = "127.0.0.1:14043";

  struct Options {
    GuestId guest;
    std::string listen;
    std::string actor;  // "": the first with a body
  };
  static Result<std::unique_ptr<RokokoReceiver>> open(const Options& options, CaptureSink& sink,
                                                      Poller& poller);
  ~RokokoReceiver() override;
  RokokoReceiver(const RokokoReceiver&) = delete;
  RokokoReceiver& operator=(const RokokoReceiver&) = delete;

  // A datagram as it comes from the socket.
  void take(const Address& from, std::span<const std::uint8_t> datagram, MonoTime received,
            MonoTime now);

  std::string summary() const override;
  InputState state() const override;
  std::string diagnosis() const override;
  const ReceivedDancer& dancer() const { return dancer_; }
  std::uint64_t refused(RokokoFault fault) const {
    return faults_[static_cast<std::size_t>(fault)];
  }

 private:
  RokokoReceiver(const Options& options, UdpSocket socket, CaptureSink& sink, Poller& poller);
  const RokokoActor* find_actor(const RokokoFrame& frame, MonoTime now);
  // Whether it was published.
  bool dance(const RokokoActor& actor, MonoTime received, MonoTime now);

  UdpSocket socket_;
  Poller& poller_;
  std::string wanted_;
  ReceivedDancer dancer_;
  OneSender sender_;
  RokokoReader reader_;
  OneWayClock clock_;
  JointFigure figure_;
  FixedString<RokokoActor::kLongestName> followed_;  // whom, where none is named
  MonoTime followed_at_;
  std::array<std::uint64_t, kRokokoFaultCount> faults_{};
  Address newest_from_;
  std::uint64_t datagrams_ = 0;
  std::uint64_t without_actor_ = 0;
  std::uint64_t incomplete_ = 0;
};

}  // namespace dance
