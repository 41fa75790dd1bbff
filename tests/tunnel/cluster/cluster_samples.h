// One of each message and value of a cluster, with every field set.
//
// Ownership: values; payloads are views of static bytes.
// Threads:   any.
// Failure:   none.
#pragma once

#include <vector>

#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/cluster/cluster_format.h"
#include "tunnel/cluster/cluster_names.h"

namespace dance::cluster_samples {

template <class Any>
std::vector<std::uint8_t> bytes_of(const Any& any) {
  std::vector<std::uint8_t> bytes(cluster::kMaxBytes);
  bytes.resize(cluster::build(any, bytes));
  return bytes;
}

inline cluster::RecordMessage record() {
  static const std::vector<std::uint8_t> payload{1, 2, 3, 4, 5};
  cluster::RecordMessage message;
  message.server = 11;
  message.link_token = 12;
  message.record.kind = wire::RecordKind::kPose;
  message.record.stream = 5u << 16 | 7;
  message.record.sequence = 1'234'567;
  message.record.capture_us = 9'876'543'210;
  message.record.published_age_us = 1000;
  message.record.sent_age_us = 2000;
  message.record.server_age_us = 3000;
  message.record.is_intra = true;
  message.record.is_base = true;
  message.record.payload = payload;
  return message;
}

inline cluster::VoiceMessage voice() {
  static const std::vector<std::uint8_t> packet{8, 6, 4, 2};
  cluster::VoiceMessage message;
  message.server = 13;
  message.link_token = 14;
  message.record.sequence = 7'654'321;
  message.record.capture_us = 9'876'543'210;
  message.record.level_dbfs = -31;
  message.record.packet = packet;
  return message;
}

inline std::vector<cluster::Message> messages() {
  cluster::Heartbeat beat;
  beat.server = 1;
  beat.born_us = 2;
  beat.links = 3;
  beat.guests = 4;
  beat.is_leaving = true;
  beat.address = Address::loopback(7400);
  cluster::FeedbackMessage feedback;
  feedback.server = 5;
  feedback.room = guest("salsa");
  feedback.path = {true, 100, 50, 400};
  for (int i = 0; i < 2; ++i) {
    cluster::FeedbackEntry entry;
    entry.guest = guest(i == 0 ? "alice" : "bob");
    entry.feedback.intra_frames = 3;
    entry.feedback.path = feedback.path;
    entry.feedback.frames.has_full = i == 0;
    entry.feedback.frames.has_base = true;
    if (i == 0) entry.feedback.frames.full = {9, 1000, 0xf0f1};
    entry.feedback.frames.base = {9, 998, 0x1};
    entry.feedback.frames.base_log2 = 2;
    entry.feedback.frames.intra_log2 = 5;
    if (!feedback.entries.try_push(entry)) std::abort();
  }
  cluster::RecordMessage channel = record();
  channel.record.kind = wire::RecordKind::kChannel;
  channel.record.channel = 3;
  FileHash hash;
  hash.bytes[0] = 1;
  static const std::vector<std::uint8_t> chunk(476, 7);
  cluster::FileMessage want{9, guest("salsa"), guest("alice"), wire::FileWant{{{}, hash}, 3, 5}};
  cluster::FileMessage part = want, refusal = want;
  part.part = wire::FileChunk{{{}, hash}, 1500, 1, chunk};
  refusal.part = wire::FileRefusal{{{}, hash}, wire::FileRefusalCause::kFull};
  return {
      beat,
      cluster::ClockQuestion{6, 7},
      cluster::ClockAnswer{8, 9, 10, 11},
      record(),
      channel,
      feedback,
      want,
      part,
      refusal,
      voice(),
      cluster::RemovalMessage{15, guest("salsa"), {guest("alice-2"), 16, guest("alice"), true}}};
}

inline std::vector<cluster::Value> values() {
  static const std::vector<std::uint8_t> payload{9, 8, 7};
  cluster::GuestValue guest_value;
  guest_value.server = 3;
  guest_value.link_token = 4;
  guest_value.since_us = 5;
  guest_value.key = {guest("alice"), true};
  return {cluster::PresenceValue{2}, guest_value,
          cluster::StateValue{6, guest("alice"), 7, payload}};
}

}  // namespace dance::cluster_samples
