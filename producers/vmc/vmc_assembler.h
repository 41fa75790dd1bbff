// VmcAssembler: puts the messages of the VMC protocol together into frames. The protocol sends a
// frame as many messages, in one packet or several, and says nowhere where one ends. A frame is
// complete, without waiting for anything:
// - at the end of the packet in which /VMC/Ext/Blend/Apply, /VMC/Ext/OK or /VMC/Ext/T follow its
//   bones;
// - at the end of the packet that brings the last of the bones that the sender is known to send;
// - or else when the next begins: with a bone that it has already, or with /VMC/Ext/T.
//
// Units/frames: our axes; p_m and R of a bone in its parent; times are receive times, and the
//               sender's seconds.
// Ownership:    one frame; never allocates.
// Threads:      none inside; one owner.
// Failure:      bones of unknown names are counted; a frame without any bone of the body is not
//               passed on.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/time.h"
#include "formats/osc/vmc_bones.h"
#include "formats/osc/vmc_message.h"

namespace dance {

struct ReceivedVmcFrame {
  std::uint64_t bones = 0;  // which came with this frame, a bit each of a dancer's row; the others'
                            // values are those that came last
  std::array<Eigen::Vector3f, kDancerBoneCount> p_m;
  std::array<Eigen::Quaternionf, kDancerBoneCount> R;
  std::uint64_t ever = 0;  // which came at all
  Eigen::Vector3f root_p_m = Eigen::Vector3f::Zero();
  Eigen::Quaternionf root_R = Eigen::Quaternionf::Identity();
  std::optional<float> time_s;
  MonoTime received;  // its first bone

  bool has(Bone bone) const { return ((bones >> index_of(bone)) & 1u) != 0; }
};

class VmcFrameSink {
 public:
  virtual ~VmcFrameSink() = default;
  virtual void on_frame(const ReceivedVmcFrame& frame) = 0;
};

class VmcAssembler {
 public:
  explicit VmcAssembler(VmcFrameSink& sink);

  void begin_packet(MonoTime received) { now_ = received; }
  void take(const VmcMessage& message);
  void end_packet();
  // For another sender.
  void forget();
  std::uint64_t unknown_bones() const { return unknown_bones_; }

 private:
  // A time stamp that comes so soon before a bone, or after one, is of the same frame.
  static constexpr Duration kTogether = Duration::ms(3);

  void take_bone(const VmcMessage& message);
  void take_time(float time_s);
  void mark();
  void note_all_of(std::uint64_t bones);
  void complete();

  VmcFrameSink& sink_;
  ReceivedVmcFrame frame_;
  MonoTime now_;
  MonoTime newest_bone_;
  bool is_marked_ = false;            // the end of the frame was seen
  std::optional<float> next_time_s_;  // came before its bones
  MonoTime next_time_received_;
  std::uint64_t since_mark_ = 0;  // bones
  std::uint64_t expected_ = 0;    // the bones that this sender sends
  std::uint64_t lacking_ = 0;     // what came instead, once
  VmcThumbs thumbs_ = VmcThumbs::kUnity;
  std::uint64_t unknown_bones_ = 0;
};

}  // namespace dance
