// What NATS may bring a server: messages with their subjects, values with their keys, and keys of
// guests. What is taken is built again, and must be the same bytes; a server with a guest in a room
// takes it too, and goes on.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "tests/fuzz_target.h"
#include "tests/tunnel/cluster/simulated_cluster.h"
#include "tunnel/cluster/cluster_bundle.h"
#include "tunnel/cluster/cluster_format.h"
#include "tunnel/cluster/cluster_names.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/server/program/cluster/cluster_keys.h"

namespace dance {
namespace {

void must(bool holds) {
  if (!holds) std::abort();
}

template <class Any>
void must_be_built_alike(const Any& any, cluster::Bytes from) {
  std::array<std::uint8_t, cluster::kMaxBytes> again;
  const std::size_t size = cluster::build(any, again);
  must(size == from.size() && std::equal(from.begin(), from.end(), again.begin()));
}

// As it comes from NATS.
void play_at_server(bool is_value, std::string_view name, cluster::Bytes bytes) {
  SimulatedCluster cluster(1);
  SimulatedTunnel::House& house = cluster[0].add("alice");
  cluster.run(Duration::ms(50));
  SimulatedCluster::Site::Arrival arrival;
  arrival.due = cluster.now();
  arrival.is_value = is_value;
  arrival.name = name;
  arrival.bytes.emplace(bytes.begin(), bytes.end());
  cluster[0].arrivals.push_back(arrival);
  cluster.run(Duration::ms(5));
  must(cluster[0].tunnel.server().guest_count() >= 1 && house.link != nullptr);
}

void play_message(std::string_view subject, cluster::Bytes bytes) {
  cluster::BundleReader bundle(bytes);
  while (const auto part = bundle.next())
    if (const auto message = cluster::parse_message(*part)) must_be_built_alike(*message, *part);
  if (bytes.size() > cluster::kMaxBytes) return;
  if (const auto message = cluster::parse_message(bytes)) must_be_built_alike(*message, bytes);
  if (const auto of = cluster::parse_pose_subject(subject))
    must(cluster::pose_subject(of->room, of->guest).view() == subject);
  if (const auto of = cluster::parse_voice_subject(subject))
    must(cluster::voice_subject(of->room, of->guest).view() == subject);
}

void play_value(std::string_view key, cluster::Bytes bytes) {
  if (bytes.size() > cluster::kMaxBytes) return;
  if (const auto value = cluster::parse_value(bytes)) must_be_built_alike(*value, bytes);
  if (const auto parsed = cluster::parse_key(key)) {
    const auto again = cluster::parse_key(cluster::text_of(*parsed).view());
    must(again && again->kind == parsed->kind && again->room == parsed->room &&
         again->guest == parsed->guest && again->server == parsed->server &&
         again->place == parsed->place);
  }
}

void play_key(std::string_view name, std::string_view line) {
  ClusterKeys keys;
  keys.take(name, line);
  must(keys.entries().size() <= 1);
  for (const auto& [id, entry] : keys.entries())
    must(id.view() == name && entry.name == id && !entry.is_local() && name != kLocalKeyName);
  if (const auto wrong = keys.take_wrong())
    for (const char c : *wrong) must(c >= ' ' && c <= '~');
  keys.take(name, std::nullopt);
  must(keys.entries().empty());
}

}  // namespace
}  // namespace dance

DANCE_FUZZ_TARGET(cluster) {
  if (size < 2) return 0;
  const std::size_t subject_size = std::min<std::size_t>(data[1], size - 2);
  const std::string_view subject(reinterpret_cast<const char*>(data) + 2, subject_size);
  const dance::cluster::Bytes bytes(data + 2 + subject_size, size - 2 - subject_size);
  switch (data[0] % 4) {
    case 0:
      dance::play_message(subject, bytes);
      break;
    case 1:
      dance::play_value(subject, bytes);
      break;
    case 3:
      dance::play_at_server((data[0] & 4) != 0, subject, bytes);
      break;
    default:
      dance::play_key(subject, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  return 0;
}
