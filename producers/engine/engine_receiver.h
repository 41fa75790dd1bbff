// EngineReceiver: a dancer whom an engine on this machine tracks, as a VR headset's application.
// The engine sends each pose with dance_producer_pose() of libdance_adapter.so; it becomes a
// capture in the turn in which it comes.
//
// Units/frames: datagrams as formats/engine/datagram.h has them; capture times in this machine's
//               clock.
// Ownership:    owns its socket; refers to sink and poller, which must outlive it. Never allocates
//               after construction.
// Threads:      the poller's.
// Failure:      open() names a name that another house has. What cannot be used is dropped and
//               counted by cause. Of several engines the first is heard whose poses are of now,
//               until it has sent none for kOtherMayFollow.
#pragma once

#include <memory>
#include <string>

#include "core/net/local_datagram.h"
#include "core/net/poller.h"
#include "formats/engine/datagram.h"
#include "producers/receive/pose_receiver.h"
#include "producers/receive/received_dancer.h"

namespace dance {

class EngineReceiver final : public PoseReceiver {
 public:
  static constexpr const char* kUsualName = "stage";
  static constexpr Duration kOtherMayFollow = Duration::s(1);
  // How far a capture time may be from now: a headset tells poses for the time of their display.
  static constexpr Duration kMostAhead = Duration::ms(100);
  static constexpr Duration kMostBehind = Duration::s(1);

  struct Counters {
    std::uint64_t foreign = 0;  // not of libdance_adapter
    std::uint64_t version = 0;
    std::uint64_t size = 0;
    std::uint64_t invalid = 0;
    std::uint64_t time = 0;          // captured too far from now
    std::uint64_t other_engine = 0;  // while another is heard
  };

  static Result<std::unique_ptr<EngineReceiver>> open(const std::string& name, const GuestId& guest,
                                                      CaptureSink& sink, Poller& poller);
  ~EngineReceiver() override;
  std::string summary() const override;
  InputState state() const override;
  std::string diagnosis() const override;

  const Counters& counters() const { return counters_; }
  const ReceivedDancer& dancer() const { return dancer_; }

 private:
  EngineReceiver(std::unique_ptr<LocalDatagramSocket> socket, const GuestId& guest,
                 CaptureSink& sink, Poller& poller);
  void drain(MonoTime now);
  void take(engine::Received& received, MonoTime now);
  void count(engine::Fault fault);

  std::unique_ptr<LocalDatagramSocket> socket_;
  Poller& poller_;
  ReceivedDancer dancer_;
  std::uint64_t session_ = 0;
  MonoTime heard_;  // a pose of that session
  std::uint64_t datagrams_ = 0;
  Counters counters_;
};

}  // namespace dance
