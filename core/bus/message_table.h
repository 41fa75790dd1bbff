// The table of message types, one row each: the type in this tree, its Signal, and the first word
// of its channels. Everything that has to name all of them is made from it: the enum, the traits
// of core/bus/encode.h, what `dance top` recognises, and the tests.
//
// A row is added at the end; the fields are in core/bus/encode.cpp, the channels in
// core/bus/channel.h.
//
// Ownership: a macro of names only.
// Threads:   none inside.
// Failure:   none.
#pragma once

#define DANCE_MESSAGE_TABLE(ROW)                    \
  ROW(Pose, kPose, "POSE")                          \
  ROW(TimedSkeleton, kSkeleton, "SKELETON")         \
  ROW(Hands, kHands, "HANDS")                       \
  ROW(GuestStatus, kGuest, "GUEST")                 \
  ROW(Stats, kStats, "STATS")                       \
  ROW(StageTime, kStageTime, "STAGE_TIME")          \
  ROW(Music, kMusic, "MUSIC")                       \
  ROW(Scene, kScene, "SCENE")                       \
  ROW(Avatar, kAvatar, "AVATAR")                    \
  ROW(AvatarFile, kAvatarFile, "AVATAR_FILE")       \
  ROW(Style, kStyle, "STYLE")                       \
  ROW(Placement, kPlacement, "PLACEMENT")           \
  ROW(Beat, kBeat, "BEAT")                          \
  ROW(GuestStats, kGuestStats, "GUEST_STATS")       \
  ROW(GuestTraffic, kGuestTraffic, "GUEST_TRAFFIC") \
  ROW(FlowSetting, kFlow, "FLOW")                   \
  ROW(Playout, kPlayout, "PLAYOUT")                 \
  ROW(Steps, kSteps, "STEPS")                       \
  ROW(Voice, kVoice, "VOICE")                       \
  ROW(Touch, kTouch, "TOUCH")                       \
  ROW(Haptic, kHaptic, "HAPTIC")                    \
  ROW(HearingWish, kHearing, "HEARING")             \
  ROW(VoiceState, kVoiceState, "VOICE_STATE")       \
  ROW(HouseLink, kHouseLink, "HOUSE_LINK")          \
  ROW(Removal, kRemoval, "REMOVAL")                 \
  ROW(VoiceLevel, kVoiceLevel, "VOICE_LEVEL")       \
  ROW(InterestWish, kInterest, "INTEREST")          \
  ROW(Face, kFace, "FACE")                          \
  ROW(RoomSong, kSong, "SONG")                      \
  ROW(Profile, kProfile, "PROFILE")                 \
  ROW(RecordingState, kRecording, "RECORDING")      \
  ROW(Chat, kChat, "CHAT")
