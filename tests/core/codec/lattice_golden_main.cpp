// Decodes golden packets and prints a hash of every bit that came out: each compiler and each flag
// must print the same. `write FILE` makes the packets anew, for a new model or format.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"
#include "core/codec/lattice/lattice_codec.h"
#include "tests/core/codec/lattice_poses.h"

namespace {

using namespace dance;

// Where decoders meet: body and skeleton of the golden packets.
Skeleton golden_skeleton() { return average_skeleton(1.7f); }

#ifndef DANCE_DECODE_ONLY
int write_packets(const char* path) {
  std::ofstream file(path, std::ios::binary);
  LatticeEncoder encoder(built_in_model());
  encoder.set_skeleton(golden_skeleton());
  Random random(1);
  std::array<std::uint8_t, kMaxPosePayload> payload{};
  for (std::uint32_t i = 0; i < 600; ++i) {
    if (i % 150 == 0) encoder.request_intra();
    encoder.set_references(i < 200   ? References::kPrevious
                           : i < 400 ? References::kPreviousTwice
                                     : References::kAcknowledged);
    encoder.set_quality(i < 300 ? 0.001 : 0.002);
    Pose pose = i % 40 == 39 ? any_pose(i, random) : dance_frame(i, random);
    if (i > 100) pose.music_beats = 0.04 * i;
    if (i % 25 == 3) pose.presence = 0x1234;
    const std::size_t size = encoder.encode(pose, payload);
    if (size == 0) return 1;
    if (i >= 6) encoder.acknowledged(i - 6);
    std::array<std::uint8_t, 6> head{};
    ByteWriter out(head);
    out.u32(i);
    out.u16(static_cast<std::uint16_t>(size));
    file.write(reinterpret_cast<const char*>(head.data()), 6);
    file.write(reinterpret_cast<const char*>(payload.data()), static_cast<std::streamsize>(size));
  }
  return file.good() ? 0 : 1;
}
#endif

int decode_packets(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
  ByteReader in({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  LatticeDecoder decoder(built_in_model());
  decoder.set_skeleton(golden_skeleton());
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&hash](const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
  };
  int count = 0;
  while (!in.is_exhausted()) {
    const std::uint32_t sequence = in.u32();
    const auto payload = in.bytes(in.u16());
    Pose pose;
    if (!in.ok() || decoder.decode(sequence, payload, pose) != DecodeResult::kPose) {
      std::printf("packet %u does not decode\n", sequence);
      return 1;
    }
    add(decoder.find(sequence)->body.x.data(), sizeof(double) * kCoordinateCount);
    for (const auto& q : pose.R_PB) add(q.coeffs().data(), 4 * sizeof(float));
    add(pose.p_WH_m.data(), 3 * sizeof(float));
    add(&pose.presence, sizeof pose.presence);
    add(&pose.music_beats, pose.music_beats == pose.music_beats ? sizeof(double) : 0);
    ++count;
  }
  std::printf("%d packets %016llx\n", count, static_cast<unsigned long long>(hash));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
#ifndef DANCE_DECODE_ONLY
  if (argc == 3 && std::strcmp(argv[1], "write") == 0) return write_packets(argv[2]);
#endif
  if (argc == 2) return decode_packets(argv[1]);
  std::fprintf(stderr, "usage: %s FILE | write FILE\n", argv[0]);
  return 2;
}
