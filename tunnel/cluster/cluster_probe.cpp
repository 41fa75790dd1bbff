#include "tunnel/cluster/cluster_probe.h"

#include <array>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr Duration kProbeQuestions = Duration::ms(25);
constexpr Duration kOldestAnswer = Duration::s(1);

}  // namespace

ClusterProbe::ClusterProbe(ServerId id, ClusterBus& bus) : id_(id), bus_(bus) {
  ClusterBus::Handlers handlers;
  handlers.on_message = [this](std::string_view, cluster::Bytes bytes, MonoTime now) {
    on_message(bytes, now);
  };
  handlers.on_value = [](std::string_view, std::optional<cluster::Bytes>, MonoTime) {};
  handlers.on_all_read = [](std::string_view, MonoTime) {};
  handlers.on_back = [](MonoTime) {};
  handlers.on_emptied = [](MonoTime) {};
  bus_.set_handlers(std::move(handlers));
  bus_.listen(cluster::beat_subject().view());
  bus_.listen(cluster::server_subject(id_).view());
}

MonoTime ClusterProbe::tick(MonoTime now) {
  std::array<std::uint8_t, cluster::kMaxBytes> buffer;
  for (const auto& [server, seen] : seen_) {
    const cluster::Message question = cluster::ClockQuestion{id_, now.since_zero_us()};
    const std::size_t size = cluster::build(question, buffer);
    DANCE_ASSERT(size > 0);
    bus_.publish(cluster::server_subject(server).view(), {buffer.data(), size});
  }
  bus_.end_turn(now);
  return now + kProbeQuestions;
}

void ClusterProbe::on_message(cluster::Bytes bytes, MonoTime now) {
  const auto message = cluster::parse_message(bytes);
  if (!message) return;
  if (const auto* beat = std::get_if<cluster::Heartbeat>(&*message)) {
    if (beat->is_leaving) {
      seen_.erase(beat->server);
    } else if (seen_.contains(beat->server) || seen_.size() < kMost) {
      seen_[beat->server].beat = *beat;
    }
    return;
  }
  const auto* answer = std::get_if<cluster::ClockAnswer>(&*message);
  const auto of = answer != nullptr ? seen_.find(answer->server) : seen_.end();
  if (of == seen_.end()) return;
  const MonoTime asked = MonoTime::from_us(answer->asked_us);
  if (asked > now || now - asked > kOldestAnswer) return;
  Seen& seen = of->second;
  const Duration there = Duration::us(answer->sent_us - answer->received_us);
  const Duration round_trip = now - asked - there;
  if (seen.answers++ > 0 && round_trip >= seen.round_trip) return;
  seen.round_trip = round_trip;
  const std::int64_t middle_us = (answer->asked_us + now.since_zero_us()) / 2;
  seen.offset = Duration::us((answer->received_us + answer->sent_us) / 2 - middle_us);
}

}  // namespace dance
