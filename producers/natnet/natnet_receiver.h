// NatNetReceiver: takes a dancer out of the stream of OptiTrack's Motive: the skeleton of a name,
// or the first. Asks the server for its version and its skeletons, once a second until it has them.
//
// Units/frames: captures in W; capture times from the stream's stamps in this house's clock.
// Ownership:    owns its sockets; refers to sink and poller.
// Threads:      none inside; runs in the poller's thread.
// Failure:      open() names the address and the cure; what cannot be used is dropped and counted
//               by cause. Packets of another machine than the server are not read. A machine
//               becomes the server by a packet that can be read whole, and is kept for good once a
//               frame of it made a pose. All that was learnt of a server that falls silent, or
//               comes back as another, is forgotten.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "core/net/one_way_clock.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "producers/natnet/natnet_body.h"
#include "producers/natnet/natnet_place.h"
#include "producers/receive/one_sender.h"
#include "producers/receive/pose_receiver.h"
#include "producers/receive/received_dancer.h"

namespace dance {

class NatNetReceiver final : public PoseReceiver {
 public:
  struct Options {
    GuestId guest;
    std::string listen;  // as producers/natnet/natnet_place.h says
    std::string actor;   // "": the first skeleton
  };
  struct Counters {
    std::uint64_t packets = 0;
    std::uint64_t of_others = 0;          // of another machine than the server
    std::uint64_t before_version = 0;     // frames while the version is not known
    std::uint64_t before_models = 0;      // frames while the skeletons' names are not
    std::uint64_t rigid_bodies_only = 0;  // frames without a skeleton
    std::uint64_t without_actor = 0;
    std::uint64_t incomplete = 0;  // with bones missing
    std::array<std::uint64_t, kNatNetFaultCount> faults{};
  };
  static Result<std::unique_ptr<NatNetReceiver>> open(const Options& options, CaptureSink& sink,
                                                      Poller& poller);
  ~NatNetReceiver() override;
  NatNetReceiver(const NatNetReceiver&) = delete;
  NatNetReceiver& operator=(const NatNetReceiver&) = delete;

  // A packet as it comes from a socket.
  void take(const Address& from, std::span<const std::uint8_t> packet, MonoTime received,
            MonoTime now);

  std::string summary() const override;
  InputState state() const override;
  std::string diagnosis() const override;
  const ReceivedDancer& dancer() const { return dancer_; }
  const Counters& counters() const { return counters_; }

 private:
  NatNetReceiver(const Options& options, const NatNetPlace& place, UdpSocket data,
                 std::optional<UdpSocket> commands, CaptureSink& sink, Poller& poller);
  void drain(UdpSocket& socket, MonoTime now);
  bool is_server(const Address& from, std::span<const std::uint8_t> packet, MonoTime now);
  void look_for_server(const Address& from, std::span<const std::uint8_t> packet, MonoTime now);
  void forget_server();
  void ask(MonoTime now);
  void request(NatNetMessage message, std::string_view text) { request(server_, message, text); }
  void request(const Address& to, NatNetMessage message, std::string_view text);
  void take_server(std::span<const std::uint8_t> packet);
  void take_models(std::span<const std::uint8_t> packet);
  // Whether it made a pose.
  bool take_frame(std::span<const std::uint8_t> packet, MonoTime received, MonoTime now);
  bool dance(const NatNetSkeleton& skeleton, MonoTime received, MonoTime now);
  bool choose_model();
  MonoTime capture_time(MonoTime received);
  NatNetFault note(NatNetFault fault);

  NatNetPlace place_;
  UdpSocket data_;
  std::optional<UdpSocket> commands_;  // none: unicast, where one socket is for both
  Poller& poller_;
  Poller::TimerId timer_ = 0;
  std::string wanted_;
  ReceivedDancer dancer_;
  OneSender sender_;  // by its machine, as answers come from another port than the stream
  Address server_;
  MonoTime server_heard_;
  MonoTime server_since_;
  MonoTime next_question_;      // to a machine that may be the server
  bool others_stream_ = false;  // since there is this server
  bool is_in_doubt_ = false;    // whether it is still the server that told its version and models
  std::uint32_t newest_frame_ = 0;
  std::optional<NatNetVersion> version_;
  std::uint64_t ticks_per_second_ = 0;
  std::unique_ptr<NatNetModels> models_;
  std::unique_ptr<NatNetFrame> frame_;
  bool has_models_ = false;
  std::optional<std::int32_t> skeleton_id_;
  std::unique_ptr<NatNetBody> body_;
  JointFigure figure_;
  OneWayClock clock_;
  Address newest_from_;
  Counters counters_;
};

}  // namespace dance
