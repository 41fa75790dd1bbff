#include "producers/vmc/vmc_assembler.h"

namespace dance {
namespace {

constexpr std::uint64_t kBody = (std::uint64_t{1} << kBoneCount) - 1;

}  // namespace

VmcAssembler::VmcAssembler(VmcFrameSink& sink) : sink_(sink) { forget(); }

void VmcAssembler::forget() {
  frame_ = ReceivedVmcFrame();
  frame_.p_m.fill(Eigen::Vector3f::Zero());
  frame_.R.fill(Eigen::Quaternionf::Identity());
  is_marked_ = false;
  next_time_s_.reset();
  since_mark_ = expected_ = lacking_ = 0;
  thumbs_ = VmcThumbs::kUnity;
}

void VmcAssembler::take(const VmcMessage& message) {
  switch (message.kind) {
    case VmcMessage::Kind::kBone:
      return take_bone(message);
    case VmcMessage::Kind::kRoot:
      frame_.root_p_m = message.p_m;
      frame_.root_R = message.R;
      return;
    case VmcMessage::Kind::kTime:
      return take_time(message.time_s);
    case VmcMessage::Kind::kAvailable:
    case VmcMessage::Kind::kBlendApply:
      return mark();
    case VmcMessage::Kind::kBlend:
    case VmcMessage::Kind::kOther:
    case VmcMessage::Kind::kMalformed:
      return;
  }
}

void VmcAssembler::take_bone(const VmcMessage& message) {
  if (const auto thumbs = thumbs_told_by(message.name)) thumbs_ = *thumbs;
  const auto bone = find_vmc_bone(message.name, thumbs_);
  if (!bone) {
    ++unknown_bones_;
    return;
  }
  if (*bone < 0) return;  // of the face
  const std::uint64_t bit = std::uint64_t{1} << *bone;
  if (is_marked_ || (frame_.bones & bit) != 0) complete();
  if ((since_mark_ & bit) != 0) {
    note_all_of(since_mark_);
    since_mark_ = 0;
  }
  if (frame_.bones == 0) {
    frame_.received = now_;
    if (next_time_s_ && now_ - next_time_received_ <= kTogether) frame_.time_s = next_time_s_;
    next_time_s_.reset();
  }
  const auto i = static_cast<std::size_t>(*bone);
  frame_.p_m[i] = message.p_m;
  frame_.R[i] = message.R;
  frame_.bones |= bit;
  frame_.ever |= bit;
  since_mark_ |= bit;
  newest_bone_ = now_;
}

void VmcAssembler::take_time(float time_s) {
  const bool follows_bones = frame_.bones != 0 && now_ - newest_bone_ <= kTogether;
  const bool is_of_this_frame = follows_bones && !frame_.time_s;
  mark();
  if (is_of_this_frame) {
    frame_.time_s = time_s;
    return;
  }
  if (frame_.bones != 0) complete();
  next_time_s_ = time_s;
  next_time_received_ = now_;
}

void VmcAssembler::mark() {
  if (frame_.bones != 0) is_marked_ = true;
  if (since_mark_ != 0) note_all_of(since_mark_);
  since_mark_ = 0;
}

// A frame that lacks bones lost a packet: only when the same lack again, the sender sends fewer.
void VmcAssembler::note_all_of(std::uint64_t bones) {
  const bool has_all = (bones & expected_) == expected_;
  if (has_all || bones == lacking_) expected_ = bones;
  lacking_ = has_all ? 0 : bones;
}

void VmcAssembler::end_packet() {
  if (frame_.bones == 0) return;
  const bool has_all = expected_ != 0 && (frame_.bones & expected_) == expected_;
  if (is_marked_ || has_all) complete();
}

void VmcAssembler::complete() {
  if ((frame_.bones & kBody) != 0) sink_.on_frame(frame_);
  frame_.bones = 0;
  frame_.time_s.reset();
  is_marked_ = false;
}

}  // namespace dance
