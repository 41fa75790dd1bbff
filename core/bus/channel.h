// Channel names: <SIGNAL>/<where>[/<guest>], e.g. POSE/capture/alice or BEAT/local. The one place
// that builds and parses them; lcmtypes/README.md holds the table of all channels and a test
// compares the two.
//
// Ownership: plain values, no allocation.
// Threads:   none inside.
// Failure:   parse() returns nullopt for names that are not ours.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/base/fixed_string.h"
#include "core/base/guest_id.h"
#include "core/bus/message_table.h"

namespace dance {

// Whose message travels on it: core/bus/message_table.h.
enum class Signal : std::uint8_t {
#define DANCE_SIGNAL(Type, kName, word) kName,
  DANCE_MESSAGE_TABLE(DANCE_SIGNAL)
#undef DANCE_SIGNAL
};

// Where on its journey the signal is.
enum class Where : std::uint8_t {
  kCapture,  // made in this house
  kGuest,    // came through the tunnel
  kStage,    // to be shown in this house
  kView,     // what a display has shown
  kRoom,     // holds for all in the room; the guest is who set it
  kLocal,    // of the whole house; there is no guest
  kProgram,  // about a program; its name takes the place of `where`, there is no guest
};

// The words of a channel name; find_where() knows what where_name() says (kLocal and kProgram,
// which have no guest, are not among them).
std::string_view signal_name(Signal signal);
std::string_view where_name(Where where);
std::optional<Where> find_where(std::string_view name);

constexpr std::size_t kMaxChannelLength = 63;  // LCM's limit

class Channel {
 public:
  Channel() = default;
  // Panics (our bug) only on a guest that is not set, or a program name that is too long.
  static Channel of(Signal signal, Where where, const GuestId& guest);
  static Channel of_house(Signal signal);  // BEAT/local
  static Channel of_program(Signal signal, std::string_view program);
  static std::optional<Channel> parse(std::string_view name);

  Signal signal() const { return signal_; }
  Where where() const { return where_; }
  const GuestId& guest() const { return guest_; }  // not set for a house's or a program's channel
  std::string_view program() const { return program_.view(); }
  const char* c_str() const { return name_.c_str(); }
  std::string_view view() const { return name_.view(); }
  bool operator==(const Channel& o) const { return name_ == o.name_; }

 private:
  Signal signal_ = Signal::kPose;
  Where where_ = Where::kCapture;
  GuestId guest_;
  FixedString<kMaxGuestIdLength> program_;
  FixedString<kMaxChannelLength> name_;
};

// One row of the table of channels.
struct ChannelRow {
  Signal signal;
  Where where;
  std::string_view pattern;  // e.g. "POSE/capture/<guest>"
  std::string_view type;     // e.g. "pose_t"
};
constexpr auto kChannelTable = std::to_array<ChannelRow>({
    {Signal::kPose, Where::kCapture, "POSE/capture/<guest>", "pose_t"},
    {Signal::kPose, Where::kGuest, "POSE/guest/<guest>", "pose_t"},
    {Signal::kPose, Where::kStage, "POSE/stage/<guest>", "pose_t"},
    {Signal::kSkeleton, Where::kCapture, "SKELETON/capture/<guest>", "skeleton_t"},
    {Signal::kSkeleton, Where::kGuest, "SKELETON/guest/<guest>", "skeleton_t"},
    {Signal::kSkeleton, Where::kStage, "SKELETON/stage/<guest>", "skeleton_t"},
    {Signal::kHands, Where::kCapture, "HANDS/capture/<guest>", "hands_t"},
    {Signal::kHands, Where::kGuest, "HANDS/guest/<guest>", "hands_t"},
    {Signal::kHands, Where::kStage, "HANDS/stage/<guest>", "hands_t"},
    {Signal::kFace, Where::kCapture, "FACE/capture/<guest>", "face_t"},
    {Signal::kFace, Where::kGuest, "FACE/guest/<guest>", "face_t"},
    {Signal::kGuest, Where::kStage, "GUEST/stage/<guest>", "guest_t"},
    {Signal::kStageTime, Where::kView, "STAGE_TIME/view/<guest>", "stage_time_t"},
    {Signal::kMusic, Where::kCapture, "MUSIC/capture/<guest>", "music_t"},
    {Signal::kMusic, Where::kRoom, "MUSIC/room/<guest>", "music_t"},
    {Signal::kSong, Where::kCapture, "SONG/capture/<guest>", "song_t"},
    {Signal::kSong, Where::kRoom, "SONG/room/<guest>", "song_t"},
    {Signal::kScene, Where::kCapture, "SCENE/capture/<guest>", "scene_t"},
    {Signal::kScene, Where::kRoom, "SCENE/room/<guest>", "scene_t"},
    {Signal::kAvatar, Where::kCapture, "AVATAR/capture/<guest>", "avatar_t"},
    {Signal::kAvatar, Where::kGuest, "AVATAR/guest/<guest>", "avatar_t"},
    {Signal::kAvatarFile, Where::kCapture, "AVATAR_FILE/capture/<guest>", "avatar_file_t"},
    {Signal::kAvatarFile, Where::kGuest, "AVATAR_FILE/guest/<guest>", "avatar_file_t"},
    {Signal::kStyle, Where::kCapture, "STYLE/capture/<guest>", "style_t"},
    {Signal::kStyle, Where::kGuest, "STYLE/guest/<guest>", "style_t"},
    {Signal::kPlacement, Where::kCapture, "PLACEMENT/capture/<guest>", "placement_t"},
    {Signal::kPlacement, Where::kGuest, "PLACEMENT/guest/<guest>", "placement_t"},
    {Signal::kBeat, Where::kLocal, "BEAT/local", "beat_t"},
    {Signal::kGuestStats, Where::kView, "GUEST_STATS/view/<guest>", "guest_stats_t"},
    {Signal::kGuestTraffic, Where::kGuest, "GUEST_TRAFFIC/guest/<guest>", "guest_traffic_t"},
    {Signal::kFlow, Where::kCapture, "FLOW/capture/<guest>", "flow_t"},
    {Signal::kFlow, Where::kStage, "FLOW/stage/<guest>", "flow_t"},
    {Signal::kPlayout, Where::kStage, "PLAYOUT/stage/<guest>", "playout_t"},
    {Signal::kSteps, Where::kCapture, "STEPS/capture/<guest>", "steps_t"},
    {Signal::kSteps, Where::kLocal, "STEPS/local", "steps_t"},
    {Signal::kVoice, Where::kCapture, "VOICE/capture/<guest>", "voice_t"},
    {Signal::kVoice, Where::kGuest, "VOICE/guest/<guest>", "voice_t"},
    {Signal::kTouch, Where::kStage, "TOUCH/stage/<guest>", "touch_t"},
    {Signal::kHaptic, Where::kCapture, "HAPTIC/capture/<guest>", "haptic_t"},
    {Signal::kHearing, Where::kLocal, "HEARING/local", "hearing_t"},
    {Signal::kVoiceState, Where::kCapture, "VOICE_STATE/capture/<guest>", "voice_state_t"},
    {Signal::kVoiceState, Where::kGuest, "VOICE_STATE/guest/<guest>", "voice_state_t"},
    {Signal::kVoiceLevel, Where::kCapture, "VOICE_LEVEL/capture/<guest>", "voice_level_t"},
    {Signal::kProfile, Where::kCapture, "PROFILE/capture/<guest>", "profile_t"},
    {Signal::kProfile, Where::kGuest, "PROFILE/guest/<guest>", "profile_t"},
    {Signal::kRecording, Where::kLocal, "RECORDING/local", "recording_t"},
    {Signal::kChat, Where::kCapture, "CHAT/capture/<guest>", "chat_t"},
    {Signal::kChat, Where::kGuest, "CHAT/guest/<guest>", "chat_t"},
    {Signal::kHouseLink, Where::kLocal, "HOUSE_LINK/local", "house_link_t"},
    {Signal::kRemoval, Where::kLocal, "REMOVAL/local", "removal_t"},
    {Signal::kInterest, Where::kLocal, "INTEREST/local", "interest_t"},
    {Signal::kStats, Where::kProgram, "STATS/<program>", "stats_t"},
});

}  // namespace dance
