// What is done with a row of the table of message types: this tree's types ⇄ the bytes of LCM
// messages. What is decoded is checked here (finite, unit rotations, sizes, times) and trusted
// behind.
//
// Units/frames: as core/pose and core/bus/messages.h say.
// Ownership:    encodes into the caller's buffer; allocates nothing.
// Threads:      none inside.
// Failure:      decode() tells a message of another type or size (kUndecodable) from one with
//               impossible values (kInvalid).
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/beat.h"
#include "core/base/steps.h"
#include "core/bus/channel.h"
#include "core/bus/chat.h"
#include "core/bus/house_messages.h"
#include "core/bus/message_table.h"
#include "core/bus/messages.h"
#include "core/bus/state_messages.h"
#include "core/bus/voice.h"
#include "core/pose/face.h"
#include "core/pose/pose.h"
#include "core/signal/flow_setting.h"
#include "core/signal/haptic.h"
#include "core/signal/playout.h"
#include "core/signal/touch.h"

namespace dance {

// Room for any one of our messages.
constexpr std::size_t kMaxMessageBytes = 1024;
using MessageBuffer = std::array<std::uint8_t, kMaxMessageBytes>;

enum class Decoded { kFine, kUndecodable, kInvalid };

// Our type, and whose channels it travels on. The generated type and its fields: encode.cpp.
template <class T, Signal kOfSignal>
struct MessageRow {
  static constexpr Signal kSignal = kOfSignal;
  static std::string_view type_name();  // as in the .lcm file
  // What each message of it begins with, most significant byte first: LCM's hash of its fields.
  static std::uint64_t fingerprint();
  // Bytes written.
  static std::size_t encode(const T& message, MessageBuffer& buffer);
  // Leaves `message` as it was unless it is kFine.
  static Decoded decode(const void* data, std::size_t size, T& message);
};

// The rows of core/bus/message_table.h.
template <class T>
struct MessageTraits;
#define DANCE_MESSAGE_TRAITS(Type, kName, word) \
  template <>                                   \
  struct MessageTraits<Type> : MessageRow<Type, Signal::kName> {};
DANCE_MESSAGE_TABLE(DANCE_MESSAGE_TRAITS)
#undef DANCE_MESSAGE_TRAITS

// A type with a row in the table.
template <class T>
concept BusMessage = requires {
  { MessageTraits<T>::kSignal } -> std::convertible_to<Signal>;
};

// visit<T>() for the type of each row.
template <class Visit>
void for_each_message_type(Visit&& visit) {
#define DANCE_VISIT(Type, kName, word) visit.template operator()<Type>();
  DANCE_MESSAGE_TABLE(DANCE_VISIT)
#undef DANCE_VISIT
}

template <BusMessage T>
std::size_t encode(const T& message, MessageBuffer& buffer) {
  return MessageTraits<T>::encode(message, buffer);
}
template <BusMessage T>
Decoded decode(const void* data, std::size_t size, T& message) {
  return MessageTraits<T>::decode(data, size, message);
}

// A pose_t as it stands in a message, every bit of it and checked for nothing: for recordings,
// which give back what they were given. For a pose that is to be used there is decode().
struct RawPose {
  Pose pose;  // without its times, which may be more than MonoTime holds
  std::int64_t capture_time_us = 0;
  std::array<std::int64_t, kHopCount> hop_time_us{};
};
// As RawPose, of hands_t.
struct RawHands {
  Hands hands;
  std::int64_t capture_time_us = 0;
};
std::size_t encode(const RawPose& raw, MessageBuffer& buffer);
std::size_t encode(const RawHands& raw, MessageBuffer& buffer);
// False for another type or size.
bool decode_unchecked(const void* data, std::size_t size, RawPose& raw);
bool decode_unchecked(const void* data, std::size_t size, RawHands& raw);

}  // namespace dance
