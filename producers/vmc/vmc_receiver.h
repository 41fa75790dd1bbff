// VmcReceiver: a dancer who comes from a program that speaks the VMC protocol: VSeeFace,
// VirtualMotionCapture, a bridge of a mocap suit, ... Each frame is published in the turn that
// completes it.
//
// Units/frames: capture times are the sender's /VMC/Ext/T mapped onto our clock where it sends one
//               that is fine enough, else when the frame was received.
// Ownership:    owns its socket; refers to sink and poller, which must outlive it; never allocates
//               after open() but for damaged packets.
// Threads:      none inside; runs in the poller's thread.
// Failure:      open() names an address that cannot be had. Packets that are no Open Sound Control,
//               messages that are malformed, unknown bones and packets of a second sender are
//               counted: summary() tells.
#pragma once

#include <memory>
#include <string>

#include "core/net/one_way_clock.h"
#include "core/net/udp_socket.h"
#include "formats/osc/osc_reader.h"
#include "producers/receive/one_sender.h"
#include "producers/receive/received_dancer.h"
#include "producers/receive/receiver_table.h"
#include "producers/vmc/vmc_assembler.h"
#include "producers/vmc/vmc_body.h"

namespace dance {

// What there is to it but the socket: packets in, captures out.
class VmcIntake final : private OscMessageSink, private VmcFrameSink {
 public:
  VmcIntake(const GuestId& guest, CaptureSink& sink) : dancer_(guest, sink), assembler_(*this) {}

  void take(std::span<const std::uint8_t> packet, MonoTime received, MonoTime now);
  // For another sender.
  void begin_anew();
  std::string summary() const;
  const ReceivedDancer& dancer() const { return dancer_; }
  std::uint64_t malformed() const { return malformed_; }
  bool is_clock_unusable() const { return clock_.is_unusable(); }
  // Why the received packets made no pose.
  std::string diagnosis() const;
  const OscReader::Counters& packets() const { return reader_.counters(); }

 private:
  void on_message(const OscMessage& message) override;
  void on_frame(const ReceivedVmcFrame& frame) override;

  OscReader reader_;
  ReceivedDancer dancer_;
  VmcAssembler assembler_;
  VmcBody body_;
  OneWayClock clock_;
  MonoTime now_;
  std::uint64_t malformed_ = 0;
  std::uint64_t with_doubles_ = 0;  // of them
  std::uint64_t bones_ = 0;         // messages of bones
};

class VmcReceiver final : public PoseReceiver {
 public:
  static constexpr const char* kUsualAddress = "127.0.0.1:39539";

  static Result<std::unique_ptr<PoseReceiver>> open(const ReceiverOptions& options,
                                                    CaptureSink& sink, Poller& poller);
  ~VmcReceiver() override;
  std::string summary() const override;
  InputState state() const override;
  std::string diagnosis() const override;

 private:
  VmcReceiver(const GuestId& guest, CaptureSink& sink, Poller& poller, UdpSocket socket);
  void drain(MonoTime now);

  Poller& poller_;
  UdpSocket socket_;
  VmcIntake intake_;
  OneSender sender_;
  Address newest_from_;
};

}  // namespace dance
