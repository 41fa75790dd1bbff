// Writes the seeds of the fuzz targets from real encodings: `make_corpus tests` from the root of the
// tree, after a change of the wire format or the codec. Not built unless asked for by name.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/tunnel/datagram_script.h"

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

void write_tunnel(const std::filesystem::path& root) {
  FuzzScene scene;
  std::map<std::string, Bytes> seeds;  // by file name
  std::map<bool, Bytes> all;
  scene.tunnel.on_datagram = [&](bool to_server, const Address& peer, wire::Bytes bytes) {
    const std::uint8_t how = peer == scene.a->address ? 0 : peer == scene.b->address ? 1 : 2;
    const Bytes datagram(bytes.begin(), bytes.end());
    const auto type = static_cast<int>(wire::parse_opening(bytes)->type);
    const std::string name = std::string(to_server ? "server_datagram/" : "link_datagram/") +
                             "type_" + std::to_string(type);
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
  tunnel.run(Duration::ms(300));
  tunnel.add_house("salsa", {"carol"});
  tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  scene.a->link->send(guest("anna"), average_skeleton(1.7f), tunnel.time_in(*scene.a));
  tunnel.run(Duration::ms(100));
  scene.b->link->say_goodbye();
  tunnel.run(Duration::ms(30));
  for (const auto& [name, script] : seeds) write(root / "tunnel/corpus" / name, script);
  write(root / "tunnel/corpus/server_datagram/conversation", all[true]);
  write(root / "tunnel/corpus/link_datagram/conversation", all[false]);
}

void write_codec(const std::filesystem::path& root) {
  const auto folder = root / "core_codec/corpus/plain_codec";
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
  Hands hands;
  hands.presence = 0xff;
  write(folder / "hands", seed(1, {out.data(), encode_hands(hands, out)}));
  write(folder / "skeleton", seed(2, {out.data(), encode_skeleton(average_skeleton(), out)}));
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "make_corpus: name the folder of tests\n");
    return 2;
  }
  dance::write_tunnel(argv[1]);
  dance::write_codec(argv[1]);
  return 0;
}
