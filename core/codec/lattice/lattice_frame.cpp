#include "core/codec/lattice/lattice_frame.h"

#include <bit>
#include <cmath>

namespace dance {
namespace {

constexpr int kHeadBits = 6;  // of the distributions below, whose frequencies add up to 64

struct Slice {
  std::uint32_t low, freq;
};
constexpr Slice kDelta{0, 61}, kIntra{61, 2}, kTwice{63, 1};
constexpr Slice kRun4{0, 54}, kRun2{54, 6}, kRun1{60, 4};
// Ages 1 to 12 by themselves, then all others.
constexpr std::array<std::uint8_t, 13> kAgeFreqs{30, 8, 5, 4, 3, 3, 2, 2, 1, 1, 1, 1, 3};
constexpr int kAgeBits = 6;
constexpr unsigned kFarAges = 13;

constexpr double kBeatSteps = 1024.0;
constexpr double kFarthestBeat = 6.0e10;                        // longer than any evening
constexpr std::int64_t kFarthestMusic = std::int64_t{1} << 47;  // more than that in steps

void write(Slice s, RangeEncoder& out) { out.encode(s.low, s.freq, kHeadBits); }

bool read_is(RangeDecoder& in, Slice yes, Slice no) {
  const bool is = in.decode_target(kHeadBits) < yes.freq;
  const Slice& s = is ? yes : no;
  in.consume(s.low, s.freq);
  return is;
}

constexpr Slice kYes{0, 62}, kNo{62, 2};  // for likely conditions

void write_likely(bool is, RangeEncoder& out) { write(is ? kYes : kNo, out); }
bool read_likely(RangeDecoder& in) { return read_is(in, kYes, kNo); }

// Predicted musical time, with its spread.
Spread music_spread(const CodedFrame& base, const CodedFrame* before, unsigned age) {
  if (before == nullptr || !before->extras.has_music) return {base.extras.music * 256, 16 + 18};
  const std::int64_t speed = base.extras.music - before->extras.music;
  return {(base.extras.music + speed * static_cast<std::int64_t>(age)) * 256, 16 + 4};
}

}  // namespace

PoseExtras extras_of(const Pose& pose) {
  PoseExtras extras;
  extras.presence = pose.presence & kAllBones;
  extras.confidence =
      static_cast<std::uint8_t>(std::lround(static_cast<double>(pose.confidence) * 63.0));
  extras.has_music = std::abs(pose.music_beats) < kFarthestBeat;  // not of NaN
  if (extras.has_music) extras.music = std::llround(pose.music_beats * kBeatSteps);
  return extras;
}

void put_extras(const PoseExtras& extras, Pose& pose) {
  pose.presence = extras.presence;
  pose.confidence = static_cast<float>(extras.confidence) / 63.0f;
  pose.music_beats = extras.has_music ? static_cast<double>(extras.music) / kBeatSteps : kNoMusic;
}

void write_head(const FrameHead& head, std::uint8_t base_level, RangeEncoder& out) {
  if (head.kind == FrameKind::kTwice) {
    write(kTwice, out);
    out.encode_bits(head.twice_bytes, 8);
    return;
  }
  if (head.kind == FrameKind::kIntra) {
    write(kIntra, out);
    out.encode_bits(head.level, 3);
    out.encode_bits(head.is_slow ? 1 : 0, 1);
    out.encode_bits(head.skeleton_tag, 8);
    return;
  }
  write(kDelta, out);
  const unsigned symbol = head.age < kFarAges ? head.age - 1u : kFarAges - 1;
  std::uint32_t low = 0;
  for (unsigned i = 0; i < symbol; ++i) low += kAgeFreqs[i];
  out.encode(low, kAgeFreqs[symbol], kAgeBits);
  if (head.age >= kFarAges) out.encode_bits(head.age, 6);
  write(head.run == 4 ? kRun4 : head.run == 2 ? kRun2 : kRun1, out);
  write_likely(head.level == base_level, out);
  if (head.level != base_level) out.encode_bits(head.level, 3);
}

void read_kind(RangeDecoder& in, FrameHead& head) {
  const std::uint32_t target = in.decode_target(kHeadBits);
  const Slice s = target < kIntra.low ? kDelta : target < kTwice.low ? kIntra : kTwice;
  in.consume(s.low, s.freq);
  head.kind = s.low == kDelta.low   ? FrameKind::kDelta
              : s.low == kIntra.low ? FrameKind::kIntra
                                    : FrameKind::kTwice;
  if (head.kind == FrameKind::kTwice)
    head.twice_bytes = static_cast<std::uint8_t>(in.decode_bits(8));
}

bool read_head(RangeDecoder& in, FrameHead& head) {
  if (head.kind == FrameKind::kIntra) {
    head.level = static_cast<std::uint8_t>(in.decode_bits(3));
    head.is_slow = in.decode_bits(1) != 0;
    head.skeleton_tag = static_cast<std::uint8_t>(in.decode_bits(8));
    return true;
  }
  const std::uint32_t target = in.decode_target(kAgeBits);
  std::uint32_t low = 0;
  unsigned symbol = 0;
  while (low + kAgeFreqs[symbol] <= target) low += kAgeFreqs[symbol++];
  in.consume(low, kAgeFreqs[symbol]);
  head.age = static_cast<std::uint8_t>(symbol + 1);
  if (head.age == kFarAges) {
    head.age = static_cast<std::uint8_t>(in.decode_bits(6));
    if (head.age < kFarAges) return false;
  }
  const std::uint32_t run = in.decode_target(kHeadBits);
  const Slice s = run < kRun2.low ? kRun4 : run < kRun1.low ? kRun2 : kRun1;
  in.consume(s.low, s.freq);
  head.run = s.low == kRun4.low ? 4 : s.low == kRun2.low ? 2 : 1;
  return true;
}

bool read_level(RangeDecoder& in, std::uint8_t base_level, FrameHead& head) {
  head.level = base_level;
  if (read_likely(in)) return true;
  head.level = static_cast<std::uint8_t>(in.decode_bits(3));
  return head.level != base_level;
}

void write_extras(const PoseExtras& extras, const CodedFrame* base, const CodedFrame* before,
                  unsigned age, const DistributionTable& table, RangeEncoder& out) {
  const PoseExtras was = base != nullptr ? base->extras : PoseExtras();
  write_likely(extras.presence == was.presence, out);
  if (extras.presence != was.presence) out.encode_bits(extras.presence, kBoneCount);
  write_likely(extras.confidence == was.confidence, out);
  if (extras.confidence != was.confidence) out.encode_bits(extras.confidence, 6);
  write_likely(extras.has_music == was.has_music, out);
  if (!extras.has_music) return;
  if (was.has_music) {
    const Spread expected = music_spread(*base, before, age);
    // Differences are 32 bits: a larger one is sent as the whole value.
    const std::int64_t off = extras.music - expected.mean_256 / 256;
    const bool is_near = off > -(1 << 20) && off < (1 << 20);
    write_likely(is_near, out);
    if (is_near) {
      SymbolDistribution(table, {0, expected.spread_class})
          .encode(static_cast<std::int32_t>(off), out);
      return;
    }
  }
  const auto raw = static_cast<std::uint64_t>(extras.music);
  out.encode_bits(static_cast<std::uint32_t>(raw >> 24), 24);
  out.encode_bits(static_cast<std::uint32_t>(raw & 0xff'ffff), 24);
}

bool read_extras(RangeDecoder& in, const CodedFrame* base, const CodedFrame* before, unsigned age,
                 const DistributionTable& table, PoseExtras& extras) {
  const PoseExtras was = base != nullptr ? base->extras : PoseExtras();
  extras = was;
  if (!read_likely(in)) extras.presence = in.decode_bits(kBoneCount);
  if (!read_likely(in)) extras.confidence = static_cast<std::uint8_t>(in.decode_bits(6));
  if (!read_likely(in)) extras.has_music = !was.has_music;
  extras.music = 0;
  if (!extras.has_music) return true;
  if (was.has_music && read_likely(in)) {
    const Spread expected = music_spread(*base, before, age);
    extras.music =
        expected.mean_256 / 256 + SymbolDistribution(table, {0, expected.spread_class}).decode(in);
    return std::abs(extras.music) < kFarthestMusic;
  }
  const std::uint64_t high = in.decode_bits(24);
  const std::uint64_t raw = high << 24 | in.decode_bits(24);
  // 48 bits with their sign
  extras.music = static_cast<std::int64_t>(raw << 16) >> 16;
  return std::abs(extras.music) < kFarthestMusic;
}

std::uint16_t check_of(const BodyLattice& lattice, std::size_t level, std::uint8_t skeleton_tag,
                       const ReferenceBody& body) {
  std::uint32_t sum = 2166136261u;
  const auto add = [&sum](std::uint32_t x) { sum = (sum ^ x) * 16777619u; };
  add(skeleton_tag);
  add(static_cast<std::uint32_t>(level));
  for (std::size_t c = 0; c < kCoordinateCount; ++c)
    add(static_cast<std::uint32_t>(
        static_cast<std::int64_t>(std::floor(body.x[c] * lattice.per_step(c, level) + 0.5))));
  return static_cast<std::uint16_t>(sum ^ sum >> 16);
}

std::uint8_t tag_of(const Skeleton& skeleton) {
  std::uint32_t sum = 2166136261u;
  const auto add = [&sum](const Eigen::Vector3f& v) {
    for (int axis = 0; axis < 3; ++axis)
      sum = (sum ^ std::bit_cast<std::uint32_t>(v[axis] + 0.0f)) * 16777619u;
  };
  for (const auto& offset : skeleton.offset_m) add(offset);
  for (const auto& tip : skeleton.tip_m) add(tip);
  return static_cast<std::uint8_t>(sum ^ sum >> 8 ^ sum >> 16 ^ sum >> 24);
}

}  // namespace dance
