// RokokoConsumer: streams the dancers as Rokoko Studio does (JSON v3 over UDP), for the plugins of
// Blender, Unity, Unreal Engine and others.
//
// Units/frames: hz in scene frames a second; a frame's timestamp counts seconds of the poses'
//               capture times since the first.
// Ownership:    owns its socket; remembers RokokoFrame::kMostActors guests; on_pose() allocates
//               nothing after construction.
// Threads:      none inside; one owner.
// Failure:      open() names the address and the cure; guests beyond the bound, actors that a
//               datagram has no room for, and what the network refused are counted.
//
// A scene frame holds the newest pose of each guest. Guests whose poses come together, as a stage
// publishes them, share one frame: it is sent when the last of them has come, so that none waits
// for another's next pose. Guests whose poses come at different times cause a frame each.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "consumers/osc/output_report.h"
#include "consumers/pose_consumer.h"
#include "core/base/token_bucket.h"
#include "core/net/udp_socket.h"
#include "formats/lz4/lz4_frame.h"
#include "formats/rokoko/rokoko_writer.h"

namespace dance {

class RokokoConsumer final : public PoseConsumer {
 public:
  static constexpr const char* kUsualAddress = "127.0.0.1:14043";
  static constexpr double kUsual_hz = 60.0;
  // Rokoko's plugin for Unreal Engine reads no longer ones; without LZ4 what UDP allows.
  static constexpr std::size_t kMostLz4Bytes = 32'768;
  static constexpr std::size_t kMostJsonBytes = 65'507;

  enum class Dialect : std::uint8_t { kLz4, kJson };
  struct Options {
    std::string address;
    Dialect dialect = Dialect::kLz4;
    double hz = 0.0;  // 0: kUsual_hz
    std::uint64_t own_clock_id = 0;
  };
  struct Counters {
    std::uint64_t heard = 0;
    std::uint64_t frames = 0;
    std::uint64_t throttled = 0;  // frames that were left out to keep the rate
    std::uint64_t left_out = 0;   // actors without room in a datagram
    std::uint64_t guests_too_many = 0;
  };

  static Result<std::unique_ptr<RokokoConsumer>> open(const Options& options);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  void on_hands(const GuestId& guest, const Hands& hands, MonoTime now) override;
  void on_second(MonoTime now) override;
  Result<void> finish() override { return {}; }
  std::string summary() const override;
  const Counters& counters() const { return counters_; }

 private:
  struct Dancer {
    GuestId guest;
    Skeleton skeleton = average_skeleton();
    Hands hands;
    bool has_hands = false;
    MonoTime hands_at;
    bool has_pose = false;
    bool is_new = false;      // since the last frame
    MonoTime arrived;         // of the newest pose
    MonoTime arrived_before;  // and of the one before
    std::size_t actor = 0;    // its place in the scene
  };

  RokokoConsumer(const Options& options, UdpSocket socket, Address to);
  Dancer* find(const GuestId& guest);
  bool waits_for_others(const Dancer& dancer, MonoTime now) const;
  void send(MonoTime now);
  void arrange_scene();

  Options options_;
  UdpSocket socket_;
  Address to_;
  TokenBucket rate_;
  std::vector<Dancer> dancers_;
  std::unique_ptr<RokokoFrame> scene_;
  RokokoWriter writer_;
  Lz4Packer packer_;
  MonoTime first_;
  MonoTime newest_;
  Counters counters_;
  OutputReport report_{"rokoko"};
};

}  // namespace dance
