#include "viewer/replay/board_feed.h"

#include "core/bus/encode.h"

namespace dance {

void BoardFeed::on_message(const Channel& channel, std::span<const std::uint8_t> message,
                           std::int64_t time_us, bool is_passed) {
  const MonoTime now = time_of(time_us);
  if (instruments_ != nullptr)
    instruments_->on_message(channel, message.data(), message.size(), now);
  if (!is_shown(channel)) return;
  const auto read = [&](auto& into) {
    return decode(message.data(), message.size(), into) == Decoded::kFine;
  };
  const Where where = channel.where();
  switch (channel.signal()) {
    case Signal::kPose: {
      Pose pose;
      if (!read(pose)) return;
      if (is_passed)
        board_.pass_over(where, channel.guest(), pose, now);
      else
        board_.on_pose(where, channel.guest(), pose, now);
      return;
    }
    case Signal::kHands:
      if (Hands hands; read(hands)) board_.on_hands(where, channel.guest(), hands, now);
      return;
    case Signal::kFace:
      if (Face face; read(face)) board_.on_face(channel.guest(), face, now);
      return;
    case Signal::kSkeleton:
      if (TimedSkeleton timed; read(timed))
        board_.on_skeleton(channel.guest(), timed.skeleton, now);
      return;
    case Signal::kGuest:
      if (GuestStatus status; read(status)) board_.on_status(channel.guest(), status, now);
      return;
    case Signal::kChat:
      if (Chat chat; read(chat)) board_.on_chat(channel.guest(), chat, now);
      return;
    case Signal::kProfile:
      // The signs of a recorded moment no longer apply.
      if (Profile profile; read(profile)) {
        profile.is_recording = profile.is_host = false;
        board_.on_profile(where, channel.guest(), profile, now);
      }
      return;
    case Signal::kBeat:
      if (Beat beat; read(beat)) board_.on_beat(beat);
      return;
    case Signal::kAvatar:
      if (Avatar avatar; read(avatar)) board_.on_avatar(channel.guest(), avatar, now);
      return;
    case Signal::kAvatarFile:
      if (AvatarFile file; read(file)) board_.on_avatar(channel.guest(), file, now);
      return;
    default:
      return;
  }
}

void BoardFeed::on_glance(const Channel& channel, const Pose* pose, std::int64_t time_us) {
  const MonoTime now = time_of(time_us);
  if (pose != nullptr)
    board_.pass_over(channel.where(), channel.guest(), *pose, now);
  else
    board_.on_hands(channel.where(), channel.guest(), Hands(), now);
}

}  // namespace dance
