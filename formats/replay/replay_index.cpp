#include "formats/replay/replay_index.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <string_view>

#include "core/base/assert.h"
#include "core/base/byte_reader.h"

namespace dance {
namespace {

using Limits = ReplayIndexLimits;

constexpr std::string_view kMagic = "DANCEIDX";
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kChecksum_bytes = 8;
constexpr std::int64_t kCentury_ns = 100LL * 366 * 24 * 3600 * 1'000'000'000;
constexpr std::int64_t kCentury_us = kCentury_ns / 1000;
constexpr double kMostBeatNumber = 1e9;

// 64-bit FNV-1a, eight bytes at a time.
std::uint64_t checksum_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  ByteReader in(bytes);
  while (in.remaining() >= 8) hash = (hash ^ in.u64()) * 0x100000001b3;
  while (in.remaining() > 0) hash = (hash ^ in.u8()) * 0x100000001b3;
  return hash ^ (hash >> 29);
}

class Writer {
 public:
  void u8(std::uint8_t v) { out_.push_back(v); }
  void u32(std::uint32_t v) { put<4>(v); }
  void u64(std::uint64_t v) { put<8>(v); }
  void i64(std::int64_t v) { u64(static_cast<std::uint64_t>(v)); }
  void time(MonoTime t) { i64(t.since_zero_ns()); }
  void count(std::size_t n) { u32(static_cast<std::uint32_t>(n)); }
  void bytes(std::span<const std::uint8_t> b) { out_.insert(out_.end(), b.begin(), b.end()); }
  void text(std::string_view t) { out_.insert(out_.end(), t.begin(), t.end()); }
  std::vector<std::uint8_t>& out() { return out_; }

 private:
  template <std::size_t kBytes>
  void put(std::uint64_t v) {
    for (std::size_t i = 0; i < kBytes; ++i)
      out_.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  }
  std::vector<std::uint8_t> out_;
};

// What is wrong stays with the first error; counts are checked against what is left before
// anything is allocated.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : in_(bytes) {}

  ByteReader& in() { return in_; }
  MonoTime time() {
    const std::int64_t ns = in_.i64();
    if (ns <= -kCentury_ns || ns >= kCentury_ns) wrong("a time is out of bounds");
    return MonoTime::from_ns(is_fine() ? ns : 0);
  }
  std::size_t count(std::size_t most, std::size_t least_bytes_each, const char* of_what) {
    const std::size_t n = in_.u32();
    if (n > most || n * least_bytes_each > in_.remaining()) wrong(of_what);
    return is_fine() ? n : 0;
  }
  void wrong(const char* what) {
    if (wrong_.empty()) wrong_ = what;
  }
  bool is_fine() const { return in_.ok() && wrong_.empty(); }
  std::string why() const { return wrong_.empty() ? "it ends too early" : wrong_; }

 private:
  ByteReader in_;
  std::string wrong_;
};

void read_head(Reader& r, ReplayIndex& index) {
  index.log = {r.in().u64(), r.in().i64(), r.in().u64()};
  const std::uint8_t stage_only = r.in().u8();
  if (stage_only > 1) r.wrong("a flag is neither 0 nor 1");
  index.stage_only = stage_only == 1;
  index.clock_id = r.in().u64();
  index.wall_ahead_us = r.in().i64();
  if (std::abs(index.wall_ahead_us / 2) >= kCentury_us / 2) r.wrong("a time is out of bounds");
  index.begin = r.time();
  index.end = r.time();
  if (index.end < index.begin) r.wrong("it ends before it begins");
  index.gaps_left_out = r.in().u64();
}

void read_guests(Reader& r, ReplayIndex& index) {
  const std::size_t guests = r.count(Limits::kGuests, 25, "too many guests");
  for (std::size_t i = 0; i < guests && r.is_fine(); ++i) {
    const auto id = GuestId::parse(r.in().text(r.in().u8()));
    if (!id) return r.wrong("a guest's name is none");
    ReplayIndex::Guest guest{*id, r.time(), r.time(), r.in().u64()};
    if (guest.last < guest.first) r.wrong("a guest leaves before it comes");
    index.guests.push_back(guest);
  }
  const std::size_t gaps = r.count(Limits::kGaps, 20, "too many gaps");
  for (std::size_t i = 0; i < gaps && r.is_fine(); ++i) {
    const std::uint32_t guest = r.in().u32();
    const MonoTime begin = r.time();
    const ReplayIndex::Gap gap{guest, begin, r.time()};
    if (gap.guest >= index.guests.size() || gap.end < gap.begin)
      return r.wrong("a gap is of nobody, or ends before it begins");
    index.gaps.push_back(gap);
  }
}

void read_beats(Reader& r, ReplayIndex& index) {
  const std::size_t beats = r.count(Limits::kBeats, 17, "too many beats");
  index.beats.reserve(beats);
  for (std::size_t i = 0; i < beats && r.is_fine(); ++i) {
    const double beat = r.in().f64();
    const MonoTime time = r.time();
    const std::uint8_t in_bar = r.in().u8();
    if (!(std::abs(beat) <= kMostBeatNumber) || in_bar > 16)
      return r.wrong("a beat is out of bounds");
    index.beats.push_back({beat, time, in_bar});
  }
  const std::size_t parts = r.count(Limits::kDensity, 4, "too many parts");
  for (std::size_t i = 0; i < parts; ++i) index.density.push_back(r.in().u32());
}

void read_checkpoints(Reader& r, ReplayIndex& index) {
  const std::size_t checkpoints = r.count(Limits::kCheckpoints, 28, "too many checkpoints");
  for (std::size_t i = 0; i < checkpoints && r.is_fine(); ++i) {
    ReplayIndex::Checkpoint each;
    each.at_bytes = r.in().u64();
    each.from_bytes = r.in().u64();
    each.reached_us = r.in().i64();
    const auto state = r.in().bytes(r.count(Limits::kState_bytes, 1, "a state is too long"));
    each.state.assign(state.begin(), state.end());
    // The first is the beginning, before anything was reached.
    const bool is_in_order =
        i == 0 || (each.at_bytes >= index.checkpoints.back().at_bytes &&
                   (i == 1 || each.reached_us >= index.checkpoints.back().reached_us));
    if (each.at_bytes > index.log.bytes || each.from_bytes > each.at_bytes || !is_in_order)
      return r.wrong("a checkpoint is not in the log");
    index.checkpoints.push_back(std::move(each));
  }
  if (index.checkpoints.empty() || index.checkpoints[0].at_bytes != 0)
    r.wrong("it has no beginning");
}

}  // namespace

std::optional<MonoTime> ReplayIndex::time_of_beat(double beat) const {
  for (std::size_t i = 0; i < beats.size(); ++i) {
    if (beats[i].beat == beat) return beats[i].time;
    if (i == 0 || beats[i - 1].beat >= beat || beats[i].beat <= beat) continue;
    const double share = (beat - beats[i - 1].beat) / (beats[i].beat - beats[i - 1].beat);
    return beats[i - 1].time +
           Duration::seconds(share * (beats[i].time - beats[i - 1].time).as_seconds());
  }
  return std::nullopt;
}

const ReplayIndex::Checkpoint& ReplayIndex::checkpoint_for(MonoTime moment) const {
  DANCE_ASSERT(!checkpoints.empty());
  const std::int64_t latest_us = (moment - kLeadIn).since_zero_us() + wall_ahead_us;
  // reached_us never falls; the first counts as reached by all.
  const auto after = std::upper_bound(
      checkpoints.begin() + 1, checkpoints.end(), latest_us,
      [](std::int64_t us, const Checkpoint& each) { return us < each.reached_us; });
  return *(after - 1);
}

std::vector<std::uint8_t> write_index(const ReplayIndex& index) {
  Writer w;
  w.text(kMagic);
  w.u32(kVersion);
  w.u64(index.log.bytes);
  w.i64(index.log.changed_ns);
  w.u64(index.log.ends_hash);
  w.u8(index.stage_only ? 1 : 0);
  w.u64(index.clock_id);
  w.i64(index.wall_ahead_us);
  w.time(index.begin);
  w.time(index.end);
  w.u64(index.gaps_left_out);
  w.count(index.guests.size());
  for (const ReplayIndex::Guest& guest : index.guests) {
    w.u8(static_cast<std::uint8_t>(guest.id.view().size()));
    w.text(guest.id.view());
    w.time(guest.first);
    w.time(guest.last);
    w.u64(guest.poses);
  }
  w.count(index.gaps.size());
  for (const ReplayIndex::Gap& gap : index.gaps) {
    w.u32(gap.guest);
    w.time(gap.begin);
    w.time(gap.end);
  }
  w.count(index.beats.size());
  for (const ReplayIndex::WholeBeat& beat : index.beats) {
    w.u64(std::bit_cast<std::uint64_t>(beat.beat));
    w.time(beat.time);
    w.u8(beat.beats_per_bar);
  }
  w.count(index.density.size());
  for (const std::uint32_t poses : index.density) w.u32(poses);
  w.count(index.checkpoints.size());
  for (const ReplayIndex::Checkpoint& each : index.checkpoints) {
    w.u64(each.at_bytes);
    w.u64(each.from_bytes);
    w.i64(each.reached_us);
    w.count(each.state.size());
    w.bytes(each.state);
  }
  w.u64(checksum_of(w.out()));
  return std::move(w.out());
}

Result<ReplayIndex> read_index(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kMagic.size() + 4 + kChecksum_bytes || bytes.size() > Limits::kFile_bytes)
    return fail("it is no index of a log");
  Reader r(bytes.first(bytes.size() - kChecksum_bytes));
  if (r.in().text(kMagic.size()) != kMagic) return fail("it is no index of a log");
  if (r.in().u32() != kVersion) return fail("it is of another version");
  if (ByteReader(bytes.last(kChecksum_bytes)).u64() !=
      checksum_of(bytes.first(bytes.size() - kChecksum_bytes)))
    return fail("it is damaged");
  ReplayIndex index;
  read_head(r, index);
  if (r.is_fine()) read_guests(r, index);
  if (r.is_fine()) read_beats(r, index);
  if (r.is_fine()) read_checkpoints(r, index);
  if (r.is_fine() && r.in().remaining() > 0) r.wrong("something follows its end");
  if (!r.is_fine()) return fail(r.why());
  return index;
}

}  // namespace dance
