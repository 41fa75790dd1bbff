// What other servers say.
#include "tunnel/cluster/cluster_bundle.h"
#include "tunnel/cluster/cluster_node.h"

namespace dance {

template <class Told>
void ClusterNode::take_record(const Told& told, const std::optional<cluster::PoseSubject>& of,
                              MonoTime now) {
  if (!of)
    ++counters_.malformed;
  else if (server_ != nullptr && told.server != options_.id)
    server_->remotes().on_record(of->room, told.server, of->guest, told.link_token, told.record,
                                 clock().to_session(now));
}

void ClusterNode::on_message(std::string_view subject, cluster::Bytes bytes, MonoTime now) {
  now_ = now;
  ++counters_.messages_in;
  counters_.bytes_in += bytes.size();
  cluster::BundleReader bundle(bytes);
  while (const auto part = bundle.next()) take(subject, *part, now);
  if (!bundle.is_good()) ++counters_.malformed;
}

void ClusterNode::take(std::string_view subject, cluster::Bytes bytes, MonoTime now) {
  const auto message = cluster::parse_message(bytes);
  if (!message) {
    ++counters_.malformed;
    return;
  }
  if (const auto* record = std::get_if<cluster::RecordMessage>(&*message)) {
    ++counters_.records_in;
    take_record(*record, cluster::parse_pose_subject(subject), now);
  } else if (const auto* voice = std::get_if<cluster::VoiceMessage>(&*message)) {
    ++counters_.voices_in;
    take_record(*voice, cluster::parse_voice_subject(subject), now);
  } else if (const auto* beat = std::get_if<cluster::Heartbeat>(&*message)) {
    take(*beat, now);
  } else if (const auto* question = std::get_if<cluster::ClockQuestion>(&*message)) {
    take(*question, now);
  } else if (const auto* answer = std::get_if<cluster::ClockAnswer>(&*message)) {
    peers_.take(*answer, now);
  } else if (const auto* feedback = std::get_if<cluster::FeedbackMessage>(&*message)) {
    take(*feedback, now);
  } else if (const auto* file = std::get_if<cluster::FileMessage>(&*message)) {
    take(*file, now);
  } else if (const auto* removal = std::get_if<cluster::RemovalMessage>(&*message)) {
    take(*removal, now);
  }
}

void ClusterNode::take(const cluster::Heartbeat& beat, MonoTime now) {
  const bool is_back = peers_.take(beat, now);
  const auto peer = peers_.all().find(beat.server);
  if (server_ == nullptr || peer == peers_.all().end() || !peer->second.is_alive) return;
  // What it had in the rooms is forgotten here: read anew.
  if (is_back) {
    for (const auto& [name, room] : rooms_) bus_.watch(cluster::keys_of(name).view());
    write_after_healing(now);
  }
  server_->remotes().note_alive(beat.server, peer->second.round_trip, clock().to_session(now));
}

void ClusterNode::take(const cluster::ClockQuestion& question, MonoTime now) {
  cluster::ClockAnswer answer;
  answer.server = options_.id;
  answer.asked_us = question.asked_us;
  answer.received_us = answer.sent_us = clock().to_session(now).since_zero_us();
  sender_.send(cluster::server_subject(question.server), answer);
}

void ClusterNode::take(const cluster::FeedbackMessage& message, MonoTime now) {
  if (server_ == nullptr || message.server == options_.id) return;
  for (const cluster::FeedbackEntry& entry : message.entries)
    server_->remotes().on_feedback(message.room, message.server, entry.guest, entry.feedback,
                                   clock().to_session(now));
}

void ClusterNode::take(const cluster::FileMessage& message, MonoTime now) {
  if (server_ == nullptr || message.server == options_.id) return;
  server_->remotes().on_file(message.room, message.server, message.guest, message.part,
                             clock().to_session(now));
}

void ClusterNode::take(const cluster::RemovalMessage& message, MonoTime now) {
  if (server_ == nullptr || message.server == options_.id) return;
  server_->removals().on_notice(message.room, message.notice, clock().to_session(now));
}

}  // namespace dance
