#include "viewer/replay/index_builder.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "core/bus/encode.h"
#include "formats/replay/index_file.h"
#include "viewer/replay/board_feed.h"
#include "viewer/replay/log_clock.h"
#include "viewer/replay/state_bytes.h"

namespace dance {
namespace {

using Limits = ReplayIndexLimits;

// Between two checkpoints: so many messages take few milliseconds to glance at.
constexpr std::uint64_t kCheckpointMessages = 8000;
constexpr std::uint64_t kProgressMessages = 4096;
constexpr double kDensityParts_hz = 4.0;
constexpr const char* kEnded = ": reading was ended before its end";

template <class Message>
std::optional<Message> decoded(std::span<const std::uint8_t> bytes) {
  Message message;
  if (decode(bytes.data(), bytes.size(), message) != Decoded::kFine) return std::nullopt;
  return message;
}

struct ClockFinder : ReplaySink {
  LogClock clock;
  void on_message(const Channel& channel, std::span<const std::uint8_t> message,
                  std::int64_t time_us, bool) override {
    if (channel.signal() != Signal::kPose) return;
    if (const auto pose = decoded<Pose>(message)) clock.see(channel.where(), *pose, time_us, false);
  }
  void on_glance(const Channel& channel, const Pose* pose, std::int64_t time_us) override {
    if (pose != nullptr) clock.see(channel.where(), *pose, time_us, true);
  }
};

// What the timeline shows, and the board whose states are kept.
class IndexSink : public ReplaySink {
 public:
  IndexSink(ReplayIndex& index, bool stage_only)
      : index_(index),
        board_(index.clock_id, stage_only),
        feed_(board_, index.wall_ahead_us),
        music_(index.clock_id) {
    const double seconds = (index.end - index.begin).as_seconds();
    const double parts =
        std::clamp(seconds * kDensityParts_hz, 16.0, static_cast<double>(Limits::kDensity));
    index.density.assign(static_cast<std::size_t>(parts), 0);
  }

  GuestBoard& board() { return board_; }

  void on_message(const Channel& channel, std::span<const std::uint8_t> message,
                  std::int64_t time_us, bool is_passed) override {
    feed_.on_message(channel, message, time_us, is_passed);
    if (channel.signal() == Signal::kPose) {
      if (const auto pose = decoded<Pose>(message)) note_pose(channel, *pose, time_us);
    } else if (channel.signal() == Signal::kBeat) {
      hear(message, feed_.time_of(time_us));
    }
  }
  void on_glance(const Channel& channel, const Pose* pose, std::int64_t time_us) override {
    feed_.on_glance(channel, pose, time_us);
    if (pose != nullptr) note_pose(channel, *pose, time_us);
  }

 private:
  // Not inlined: g++ 12 takes the copies in MusicHere for pointers to this frame.
  [[gnu::noinline]] void hear(std::span<const std::uint8_t> message, MonoTime now) {
    const auto beat = decoded<Beat>(message);
    if (!beat) return;
    music_.hear(*beat);
    note_beat(now);
  }

  void note_pose(const Channel& channel, const Pose& pose, std::int64_t time_us) {
    const MonoTime now = feed_.time_of(time_us);
    if (channel.where() != Where::kGuest) note_guest(channel.guest(), now);
    if (channel.where() != Where::kCapture) return;
    music_.see(pose);
    note_beat(now);
  }

  void note_guest(const GuestId& id, MonoTime now) {
    auto found = place_of_.find(id);
    if (found == place_of_.end()) {
      if (index_.guests.size() == Limits::kGuests) return;
      found = place_of_.emplace(id, index_.guests.size()).first;
      index_.guests.push_back({id, now, now, 0});
    }
    ReplayIndex::Guest& guest = index_.guests[found->second];
    if (now - guest.last > ReplayIndex::kLongestStep) {
      if (index_.gaps.size() < Limits::kGaps)
        index_.gaps.push_back({static_cast<std::uint32_t>(found->second), guest.last, now});
      else
        ++index_.gaps_left_out;
    }
    guest.last = std::max(guest.last, now);
    ++guest.poses;
    const double seconds = (index_.end - index_.begin).as_seconds();
    const double share = seconds > 0.0 ? (now - index_.begin).as_seconds() / seconds : 0.0;
    const double part = std::floor(share * static_cast<double>(index_.density.size()));
    const double last = static_cast<double>(index_.density.size() - 1);
    ++index_.density[static_cast<std::size_t>(std::clamp(part, 0.0, last))];
  }

  void note_beat(MonoTime now) {
    const BeatClock& clock = music_.clock();
    if (!clock.is_known(now)) return;
    const double beats = clock.position(now);
    if (was_known_ && beats > before_ && beats - before_ < 2.0 &&
        index_.beats.size() < Limits::kBeats && std::floor(beats) > std::floor(before_))
      index_.beats.push_back({std::floor(beats), clock.time_of(std::floor(beats)),
                              static_cast<std::uint8_t>(clock.beats_per_bar())});
    before_ = beats;
    was_known_ = true;
  }

  ReplayIndex& index_;
  GuestBoard board_;
  BoardFeed feed_;
  MusicHere music_;
  double before_ = 0.0;
  bool was_known_ = false;
  std::map<GuestId, std::size_t> place_of_;
};

// Keeps the board's states. A beat meter's samples are left out of one where as many others follow
// within the lead-in, which is known only then.
class Checkpoints {
 public:
  Checkpoints(ReplayIndex& index, GuestBoard& board) : index_(index), board_(board) {
    index_.checkpoints.push_back({});  // the beginning
  }

  void after(ReplayLog& log, std::int64_t time_us) {
    reached_us_ = count_ == 0 ? time_us : std::max(reached_us_, time_us);
    settle();
    if (++count_ % kCheckpointMessages != 0 || index_.checkpoints.size() >= Limits::kCheckpoints)
      return;
    Pending pending;
    pending.place = index_.checkpoints.size();
    pending.full = state([](const GuestId&, bool) { return true; });
    Counts counts;
    pending.bare = state([&](const GuestId& guest, bool of_arriving) {
      const std::size_t count = board_.beat_samples_of(guest, of_arriving);
      const Meter meter{guest, of_arriving};
      counts[meter] = count;
      const auto found = counts_.find(meter);
      const bool is_fast = found != counts_.end() && count >= found->second + BeatMeter::kSamples;
      if (is_fast) pending.left_out.emplace_back(meter, count);
      return !is_fast && count > 0;
    });
    counts_since(counts);
    index_.checkpoints.push_back(
        {log.next_at_bytes(), log.needed_from_bytes(time_us), reached_us_, {}});
    pending_.push_back(std::move(pending));
  }

  void finish() {
    for (Pending& pending : pending_)
      index_.checkpoints[pending.place].state = std::move(pending.full);
    pending_.clear();
  }

 private:
  using Meter = std::pair<GuestId, bool>;  // bool: of what arrives
  using Counts = std::map<Meter, std::size_t>;
  struct Pending {
    std::size_t place = 0;
    std::vector<std::uint8_t> full, bare;
    std::vector<std::pair<Meter, std::size_t>> left_out;  // and how many samples each had
  };

  template <class HasSamples>
  std::vector<std::uint8_t> state(HasSamples has_samples) {
    ReplayStateWriter writer;
    board_.carry(writer, has_samples);
    return std::move(writer.bytes());
  }

  // Counts of at least a lead-in ago, to tell who is fast.
  void counts_since(const Counts& counts) {
    earlier_.emplace_back(reached_us_, counts);
    while (earlier_.size() > 1 &&
           reached_us_ - earlier_[1].first >= ReplayIndex::kLeadIn.count_us())
      earlier_.pop_front();
    counts_ = earlier_.front().second;
  }

  void settle() {
    while (!pending_.empty()) {
      Pending& first = pending_.front();
      ReplayIndex::Checkpoint& kept = index_.checkpoints[first.place];
      if (reached_us_ - kept.reached_us < ReplayIndex::kLeadIn.count_us()) return;
      const bool is_enough =
          std::all_of(first.left_out.begin(), first.left_out.end(), [&](const auto& each) {
            return board_.beat_samples_of(each.first.first, each.first.second) >=
                   each.second + BeatMeter::kSamples;
          });
      kept.state = std::move(is_enough ? first.bare : first.full);
      pending_.pop_front();
    }
  }

  ReplayIndex& index_;
  GuestBoard& board_;
  std::uint64_t count_ = 0;
  std::int64_t reached_us_ = 0;
  std::deque<Pending> pending_;
  Counts counts_;
  std::deque<std::pair<std::int64_t, Counts>> earlier_;
};

// Passes on, and remembers the time.
class TimedSink : public ReplaySink {
 public:
  explicit TimedSink(ReplaySink& to) : to_(to) {}
  void on_message(const Channel& channel, std::span<const std::uint8_t> message,
                  std::int64_t time_us, bool is_passed) override {
    time_us_ = time_us;
    to_.on_message(channel, message, time_us, is_passed);
  }
  void on_glance(const Channel& channel, const Pose* pose, std::int64_t time_us) override {
    time_us_ = time_us;
    to_.on_glance(channel, pose, time_us);
  }
  std::int64_t time_us() const { return time_us_; }

 private:
  ReplaySink& to_;
  std::int64_t time_us_ = 0;
};

// False when it was ended.
template <class After>
bool read_all(ReplayLog& log, ReplaySink& sink, double of_bytes, double done,
              const ReadingProgress& goes_on, After after) {
  log.rewind();
  for (std::uint64_t count = 0; log.look(sink); ++count) {
    after();
    if (count % kProgressMessages != 0) continue;
    const double share = of_bytes > 0 ? static_cast<double>(log.next_at_bytes()) / of_bytes : 1.0;
    if (goes_on && !goes_on(done + 0.5 * std::min(share, 1.0))) return false;
  }
  return true;
}

}  // namespace

Result<ReplayIndex> build_index(ReplayLog log, const std::string& name, const LogMark& mark,
                                bool stage_only, const ReadingProgress& goes_on) {
  ReplayIndex index;
  index.log = mark;
  index.stage_only = stage_only;
  const auto bytes = static_cast<double>(mark.bytes);
  ClockFinder finder;
  if (!read_all(log, finder, bytes, 0.0, goes_on, [] {})) return fail(name + kEnded);
  // A log that cannot be read on may have its poses behind that.
  if (auto ended = log.ended(); !ended) return tl::make_unexpected(ended.error());
  if (!finder.clock.is_known())
    return fail(name +
                ": nobody dances in this log; record a house with a manager, or a camera with "
                "dance capture --record");
  index.clock_id = finder.clock.clock_id();
  index.wall_ahead_us = finder.clock.wall_ahead_us();
  index.begin = finder.clock.begin();
  index.end = std::max(index.begin, finder.clock.end());

  IndexSink sink(index, stage_only);
  Checkpoints checkpoints(index, sink.board());
  TimedSink timed(sink);
  if (!read_all(log, timed, bytes, 0.5, goes_on, [&] { checkpoints.after(log, timed.time_us()); }))
    return fail(name + kEnded);
  checkpoints.finish();
  if (auto ended = log.ended(); !ended) return tl::make_unexpected(ended.error());
  return index;
}

Result<ReplayIndex> build_index(const std::string& path, bool stage_only,
                                const ReadingProgress& goes_on) {
  DANCE_TRY(ReplayLog log, ReplayLog::open(path));
  DANCE_TRY(const LogMark mark, mark_of_log(path));
  return build_index(std::move(log), path, mark, stage_only, goes_on);
}

Result<IndexedLog> index_of_log(const std::string& path, bool stage_only,
                                const ReadingProgress& goes_on) {
  DANCE_TRY(ReplayLog log, ReplayLog::open(path));
  DANCE_TRY(const LogMark mark, mark_of_log(path));
  if (auto kept = load_index(path, mark, stage_only)) return IndexedLog{std::move(*kept), "", true};
  DANCE_TRY(ReplayIndex index, build_index(std::move(log), path, mark, stage_only, goes_on));
  IndexedLog indexed{std::move(index), "", false};
  if (const auto saved = save_index(path, indexed.index); !saved)
    indexed.note = "the index is not kept, and is made again next time: " + saved.error().what;
  return indexed;
}

}  // namespace dance
