// Writes the seeds of the fuzz targets from real encodings: `make_corpus tests` from the root of
// the tree, after a change of the wire format or the codec. Not built unless asked for by name.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/codec/hands_codec.h"
#include "core/codec/lossless/lossless_codec.h"
#include "tests/tunnel/cluster/cluster_samples.h"
#include "tests/tunnel/datagram_script.h"
#include "tunnel/seal/keys/identity_key.h"
#include "tunnel/seal/keys/preshared_key.h"
#include "tunnel/wire/wire_room.h"

namespace dance {
namespace {

using Bytes = std::vector<std::uint8_t>;

void write(const std::filesystem::path& path, const Bytes& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  std::printf("%s: %zu bytes\n", path.c_str(), bytes.size());
}

void append_step(Bytes& script, std::uint8_t how, const Bytes& datagram) {
  script.push_back(how);
  script.push_back(static_cast<std::uint8_t>(datagram.size()));
  script.push_back(static_cast<std::uint8_t>(datagram.size() >> 8));
  script.insert(script.end(), datagram.begin(), datagram.end());
}

// A fingerprint, one number, and the text "ab".
Bytes light_message() {
  return {1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 1, 63, 128, 0, 0, 0, 0, 0, 3, 'a', 'b', 0};
}

// Records of channels, and those with more in their heads, are kinds of their own.
std::string more_of(wire::Bytes datagram) {
  const auto opening = wire::parse_opening(datagram);
  if (opening->type == wire::Type::kInterest)
    return wire::parse_interest_list(opening->body)->voices.is_default() ? "" : "_voices";
  if (opening->type != wire::Type::kRecords) return "";
  ByteReader in(opening->body);
  if (!wire::parse_records_header(in)) return "";
  for (wire::RecordChain chain; in.remaining() > 0;) {
    const auto record = wire::parse_record(chain, in);
    if (record->kind == wire::RecordKind::kChannel) return "_channel";
    if (record->is_retained) return "_kept";
    if (record->counts_left_out) return "_left_out";
    if (record->is_base) return "_base";
  }
  return "";
}

void write_tunnel(const std::filesystem::path& root) {
  FuzzScene scene;
  std::map<std::string, Bytes> seeds;  // by file name
  std::map<bool, Bytes> all;
  constexpr int kFileSteps = 12;
  int file_steps = 0;
  const SimulatedTunnel::House* host = nullptr;
  scene.tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    const std::uint8_t how = peer == scene.a->peer ? 0 : peer == scene.b->peer ? 1 : 2;
    const Bytes datagram(bytes.begin(), bytes.end());
    const auto type = wire::parse_opening(bytes)->type;
    // Acknowledgements and feedback alone are a kind of their own.
    const bool is_bare = type == wire::Type::kRecords && (bytes[0] & 16) == 0;
    // One of each kind of state that comes first in its datagram.
    const std::string kind =
        type == wire::Type::kState ? "_kind_" + std::to_string(bytes[1] & 15) : "";
    const std::string name = std::string(to_server ? "server_datagram/" : "link_datagram/") +
                             "type_" + std::to_string(static_cast<int>(type)) +
                             (is_bare ? "_bare" : "") + more_of(bytes) + kind;
    // Two files that are under way in one room, from their choices on.
    const bool is_of_files = type >= wire::Type::kFileTerms && type <= wire::Type::kFileRefusal;
    if (to_server && (is_of_files || kind == "_kind_8") && ++file_steps <= kFileSteps)
      append_step(seeds["server_datagram/two_files"], how, datagram);
    // A host that comes, and removes bob.
    const bool is_of_removal =
        type == wire::Type::kHello || type == wire::Type::kRemoval || type == wire::Type::kPing;
    if (to_server && host != nullptr && peer == host->peer && is_of_removal)
      append_step(seeds["server_datagram/removal"], how, datagram);
    if (!seeds.contains(name)) {
      append_step(seeds[name], how, datagram);
      append_step(all[to_server], how, datagram);
    }
    return true;
  };
  auto& tunnel = scene.tunnel;
  tunnel.dance(*scene.a, guest("alice"));
  tunnel.dance(*scene.b, guest("bob"));
  scene.a->link->send(guest("alice"), average_skeleton(1.6f), tunnel.time_in(*scene.a));
  scene.b->link->send(guest("bob"), average_skeleton(1.8f), tunnel.time_in(*scene.b));
  Music music;
  music.clock_id = scene.a->clock_id;
  music.start_time = tunnel.time_in(*scene.a);
  scene.a->link->send(guest("alice"), music, tunnel.time_in(*scene.a));
  scene.b->link->send(guest("bob"), Scene(), tunnel.time_in(*scene.b));
  scene.b->link->send(guest("bob"), Avatar(), tunnel.time_in(*scene.b));
  scene.b->link->send(guest("bob"), Style(), tunnel.time_in(*scene.b));
  scene.b->link->send(guest("bob"), Placement(), tunnel.time_in(*scene.b));
  scene.b->link->send(guest("bob"), Chat{{}, 0, ChatKind::kHeart, {}}, tunnel.time_in(*scene.b));
  AvatarFile file;
  file.hash.bytes.fill(7);
  file.size_bytes = 3000;
  scene.b->link->files().offer(guest("bob"), file.hash,
                               std::make_shared<const std::vector<std::uint8_t>>(3000, 9));
  scene.b->link->send(guest("bob"), file, tunnel.time_in(*scene.b));
  // A second one, of another size, so that two are under way at once.
  AvatarFile large = file;
  large.hash.bytes.fill(9);
  large.size_bytes = 300'000;
  scene.a->link->files().offer(guest("alice"), large.hash,
                               std::make_shared<const std::vector<std::uint8_t>>(300'000, 9));
  scene.a->link->send(guest("alice"), large, tunnel.time_in(*scene.a));
  tunnel.run(Duration::ms(50));
  for (auto* house : {scene.a, scene.b}) {
    const AvatarFile& of_other = house == scene.a ? file : large;
    house->link->files().fetch(guest(house == scene.a ? "bob" : "alice"), of_other.hash,
                               ChunkedFile(static_cast<std::uint32_t>(of_other.size_bytes)),
                               tunnel.time_in(*house));
  }
  for (int i = 0; i < 3; ++i) {
    for (auto* house : {scene.a, scene.b}) {
      house->link->send_channel("LIGHT/desk", light_message(), tunnel.time_in(*house));
      house->link->send_channel("ROBOT/arm", light_message(), tunnel.time_in(*house));
    }
    tunnel.run(Duration::ms(100));
  }
  // Refusals: of the house, which has lost it, and of the server.
  scene.a->link->files().offer(guest("alice"), large.hash, nullptr);
  tunnel.run(Duration::ms(100));
  FileHash unknown = large.hash;
  unknown.bytes[0] = 1;
  scene.b->link->files().fetch(guest("alice"), unknown, ChunkedFile(3000),
                               tunnel.time_in(*scene.b));
  tunnel.run(Duration::ms(100));
  Interest interest;
  if (interest.guests.try_push({guest("bob"), 2}))
    scene.a->link->set_interest(interest, tunnel.time_in(*scene.a));
  for (int i = 0; i < 4; ++i) {
    tunnel.run(Duration::ms(30));
    tunnel.dance(*scene.b, guest("bob"));
  }
  Hearing hearing;
  hearing.others = false;
  if (hearing.exceptions.try_push(guest("bob")))
    scene.a->link->set_hearing(hearing, tunnel.time_in(*scene.a));
  tunnel.run(Duration::ms(30));
  Voice voice;
  const std::vector<std::uint8_t> packet(40, 5);
  if (!voice.set_packet(packet)) std::abort();
  for (int i = 0; i < 2; ++i) {
    voice.clock_id = scene.b->clock_id;
    voice.capture_time = tunnel.time_in(*scene.b);
    ++voice.sequence;
    scene.b->link->send(guest("bob"), voice, tunnel.time_in(*scene.b));
  }
  tunnel.run(Duration::ms(30));
  tunnel.add_house("salsa", {"carol"});
  tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  scene.a->link->send(guest("anna"), average_skeleton(1.7f), tunnel.time_in(*scene.a));
  tunnel.run(Duration::ms(100));
  // A host's link, as the peers 0 and 1 are not: what it is told, and whom it removes.
  auto& hanna = tunnel.add_house("salsa", {"hanna"}, {}, {.role = Role::kHost, .any_name = true});
  host = &hanna;
  tunnel.run(Duration::ms(100));
  hanna.link->ask_removal(guest("nobody"), 7);
  tunnel.run(Duration::ms(30));
  hanna.link->ask_removal(guest("carol"), 8);
  hanna.link->ask_removal(guest("bob"), 9);
  tunnel.run(Duration::ms(30));
  host = nullptr;
  scene.a->link->ask_removal(guest("hanna"), 10);
  tunnel.run(Duration::ms(30));
  // One who asks who is there, and is not; and another, whose key opens another room.
  for (const Access& access :
       {Access{.any_name = true}, Access{.name = guest("dora"), .room = guest("tango")}}) {
    std::array<std::uint8_t, 64> out;
    const wire::RoomQuestion question{11, guest("salsa")};
    const std::span<const std::uint8_t> datagram(out.data(), wire::build(question, out));
    const Bytes bytes(datagram.begin(), datagram.end());
    append_step(seeds["server_datagram/type_34"], access.any_name ? 2 : 3, bytes);
    tunnel.inject(tunnel.add_peer(access), datagram);
  }
  scene.a->link->send_goodbye();
  tunnel.run(Duration::ms(30));
  for (const auto& [name, script] : seeds) write(root / "tunnel/corpus" / name, script);
  write(root / "tunnel/corpus/server_datagram/conversation", all[true]);
  write(root / "tunnel/corpus/link_datagram/conversation", all[false]);
}

// As cluster_fuzz.cpp reads them: the kind, the length of a subject or key, that, and bytes.
void write_cluster(const std::filesystem::path& folder) {
  const auto write_seed = [&](const std::string& name, std::uint8_t kind, std::string_view subject,
                              const Bytes& bytes) {
    Bytes seed{kind, static_cast<std::uint8_t>(subject.size())};
    seed.insert(seed.end(), subject.begin(), subject.end());
    seed.insert(seed.end(), bytes.begin(), bytes.end());
    write(folder / name, seed);
  };
  const auto salsa = *GuestId::parse("salsa"), alice = *GuestId::parse("alice");
  const cluster::Text pose = cluster::pose_subject(salsa, alice);
  int number = 0;
  const cluster::Text voice = cluster::voice_subject(salsa, alice);
  for (const cluster::Message& message : cluster_samples::messages()) {
    const bool is_voice = std::holds_alternative<cluster::VoiceMessage>(message);
    const std::string_view subject = (is_voice ? voice : pose).view();
    write_seed("message_" + std::to_string(number), 0, subject, cluster_samples::bytes_of(message));
    write_seed("message_at_server_" + std::to_string(number++), 3, subject,
               cluster_samples::bytes_of(message));
  }
  using cluster::KeyKind;
  const std::array<cluster::Key, 4> keys{cluster::Key{KeyKind::kPresence, salsa, 2, {}, 0},
                                         cluster::Key{KeyKind::kGuest, salsa, 0, alice, 0},
                                         cluster::Key{KeyKind::kGuestState, salsa, 0, alice, 1},
                                         cluster::Key{KeyKind::kRoomState, salsa, 0, {}, 1}};
  const auto values = cluster_samples::values();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Bytes bytes = cluster_samples::bytes_of(values[std::min(i, values.size() - 1)]);
    write_seed("value_" + std::to_string(i), 1, cluster::text_of(keys[i]).view(), bytes);
    write_seed("value_at_server_" + std::to_string(i), 7, cluster::text_of(keys[i]).view(), bytes);
  }
  const std::string line = "alice guest * " + PrivateKey::make().public_key().text();
  write_seed("key", 2, "alice", Bytes(line.begin(), line.end()));
  const std::string identity = PrivateKey::make().public_key().text();
  write_seed("identity", 2, "_identity", Bytes(identity.begin(), identity.end()));
}

void write_codec(const std::filesystem::path& root) {
  const auto folder = root / "core/codec/corpus/plain_codec";
  const auto seed = [](std::uint8_t kind, std::span<const std::uint8_t> payload) {
    Bytes bytes(1 + payload.size(), kind);
    std::copy(payload.begin(), payload.end(), bytes.begin() + 1);
    return bytes;
  };
  std::array<std::uint8_t, kMaxPosePayload> out;
  PlainEncoder encoder;
  Pose pose = pose_number(77, MonoTime::from_us(1), 1);
  pose.music_beats = 33.25;
  write(folder / "pose_whole", seed(0, {out.data(), encoder.encode(pose, out)}));
  pose.presence = 0x1234;
  write(folder / "pose_parts", seed(0, {out.data(), encoder.encode(pose, out)}));
  write(folder / "skeleton", seed(1, {out.data(), encode_skeleton(average_skeleton(), out)}));
}

void write_hands(const std::filesystem::path& folder) {
  std::array<std::uint8_t, kMaxHandsPayload> out;
  const auto write_one = [&](const char* name, const Hands& hands) {
    const std::size_t size = encode_hands(hands, out);
    write(folder / name, Bytes(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(size)));
  };
  Hands hands;
  write_one("none", hands);
  hands.presence = (1u << kFingerBoneCount) - 1;
  write_one("rest", hands);
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    hands.R_PB[i].coeffs() << 0.0f, 0.01f * static_cast<float>(i), i < 15 ? -0.3f : 0.35f, 0.9f;
  normalize(hands);
  write_one("whole", hands);
  hands.presence = 0x1fff7fff;
  write_one("parts", hands);
}

// Frames with two bytes of length before each, as lossless_codec_fuzz.cpp reads them.
void write_lossless(const std::filesystem::path& folder) {
  LosslessEncoder encoder;
  std::array<std::uint8_t, kMaxLosslessPayload> out;
  Bytes bytes;
  for (std::uint32_t n = 0; n < 7; ++n) {
    const std::size_t size = encoder.encode(pose_number(n, MonoTime::from_us(1), 1), out);
    bytes.push_back(static_cast<std::uint8_t>(size));
    bytes.push_back(static_cast<std::uint8_t>(size >> 8));
    bytes.insert(bytes.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(size));
  }
  write(folder / "moves", bytes);
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "make_corpus: name the folder of tests\n");
    return 2;
  }
  dance::write_tunnel(argv[1]);
  dance::write_cluster(std::filesystem::path(argv[1]) / "tunnel/cluster/corpus");
  dance::write_codec(argv[1]);
  const std::filesystem::path corpus = std::filesystem::path(argv[1]) / "core/codec/corpus";
  dance::write_hands(corpus / "hands_codec");
  dance::write_lossless(corpus / "lossless_codec");
  return 0;
}
