#include "bench/replay/bench_replay.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numeric>
#include <random>

#include "core/net/mono_clock.h"
#include "formats/replay/index_file.h"
#include "testing/scratch_folder.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/replay/index_builder.h"
#include "viewer/replay/replay_feed.h"

namespace dance {
namespace {

double ms_since(MonoTime begun) { return 1e3 * (mono_now() - begun).as_seconds(); }

// What a window has open.
class Opened {
 public:
  static Result<std::unique_ptr<Opened>> open(const std::string& path,
                                              std::shared_ptr<const ReplayIndex> index) {
    std::unique_ptr<Opened> opened(new Opened(index->clock_id));
    DANCE_TRY(ReplayFeed feed, ReplayFeed::open(path, std::move(index), opened->board_));
    opened->feed_.emplace(std::move(feed));
    return opened;
  }
  ReplayFeed& feed() { return *feed_; }
  const SceneState& jump(MonoTime moment) {
    feed_->show(moment);
    return scene(moment);
  }
  const SceneState& scene(MonoTime moment) {
    roster_.update(moment, scene_);
    return scene_;
  }

 private:
  explicit Opened(std::uint64_t clock_id) : board_(clock_id, false), roster_(board_) {}
  GuestBoard board_;
  StageRoster roster_;
  SceneState scene_;
  std::optional<ReplayFeed> feed_;
};

// Enough of a scene to tell it from another moment's.
struct Seen {
  GuestId guest;
  std::uint32_t sequence;
  MonoTime captured;
  Eigen::Vector3f p_WH_m;
  bool operator==(const Seen&) const = default;
};
std::vector<Seen> seen_in(const SceneState& scene) {
  std::vector<Seen> seen;
  for (const SceneGuest& guest : scene.guests)
    seen.push_back({guest.id, guest.pose.sequence, guest.pose.capture_time, guest.pose.p_WH_m});
  return seen;
}

struct OpenTimes {
  double index_ms = 0.0, all_ms = 0.0;
};
Result<std::unique_ptr<Opened>> open_as_a_window_does(const std::string& path, OpenTimes& times) {
  const MonoTime begun = mono_now();
  DANCE_TRY(IndexedLog indexed, index_of_log(path, false, {}));
  times.index_ms = ms_since(begun);
  if (!indexed.note.empty()) return fail(indexed.note);
  const auto index = std::make_shared<const ReplayIndex>(std::move(indexed.index));
  DANCE_TRY(auto opened, Opened::open(path, index));
  opened->jump(index->begin);
  times.all_ms = ms_since(begun);
  return opened;
}

void forget_index(const std::string& path) {
  std::error_code ignored;
  for (const std::string& place : index_places(path, false))
    std::filesystem::remove(place, ignored);
}

std::uint64_t index_bytes_of(const std::string& path) {
  std::error_code error;
  for (const std::string& place : index_places(path, false))
    if (const auto bytes = std::filesystem::file_size(place, error); !error) return bytes;
  return 0;
}

class Run {
 public:
  Run(const BenchReplayOptions& options, std::string path)
      : options_(options), path_(std::move(path)) {}

  Result<BenchReplayResult> run() {
    std::error_code error;
    result_.log_bytes = std::filesystem::file_size(path_, error);
    forget_index(path_);
    OpenTimes first;
    DANCE_TRY(auto opened, open_as_a_window_does(path_, first));
    result_.index_ms = first.index_ms;
    result_.open_first_ms = first.all_ms;
    result_.index_bytes = index_bytes_of(path_);
    for (int i = 0; i < options_.opens; ++i) {
      OpenTimes later;
      DANCE_TRY(opened, open_as_a_window_does(path_, later));
      result_.open_ms.push_back(later.all_ms);
    }
    const ReplayIndex& index = opened->feed().index();
    result_.guests = index.guests.size();
    result_.length_s = (index.end - index.begin).as_seconds();
    seek(*opened);
    if (options_.has_baseline) {
      DANCE_TRY(auto reading, Opened::open(path_, std::make_shared<const ReplayIndex>(index)));
      read(*reading);
    }
    for (auto* samples : {&result_.open_ms, &result_.seek_ms, &result_.reading_ms})
      std::sort(samples->begin(), samples->end());
    return std::move(result_);
  }

 private:
  void seek(Opened& opened) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> anywhere(0.0, result_.length_s);
    for (int i = 0; i < options_.seeks; ++i) {
      const MonoTime moment = opened.feed().index().begin + Duration::seconds(anywhere(random));
      const MonoTime begun = mono_now();
      const SceneState& scene = opened.jump(moment);
      result_.seek_ms.push_back(ms_since(begun));
      moments_.push_back(moment);
      seen_.push_back(seen_in(scene));
    }
  }
  // Once from the beginning to the end: until each moment it takes what reading to it alone does.
  void read(Opened& reading) {
    std::vector<std::size_t> order(moments_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return moments_[a] < moments_[b]; });
    const MonoTime begun = mono_now();
    reading.feed().show_from_the_beginning(reading.feed().index().begin);
    for (const std::size_t i : order) {
      reading.feed().read_on_to(moments_[i]);
      const SceneState& scene = reading.scene(moments_[i]);
      result_.reading_ms.push_back(ms_since(begun));
      if (seen_in(scene) != seen_[i]) ++result_.different;
    }
  }

  const BenchReplayOptions& options_;
  std::string path_;
  BenchReplayResult result_;
  std::vector<MonoTime> moments_;
  std::vector<std::vector<Seen>> seen_;
};

}  // namespace

Result<BenchReplayResult> run_bench_replay(const BenchReplayOptions& options) {
  if (!options.log.empty()) return Run(options, options.log).run();
  DANCE_TRY(const auto folder, ScratchFolder::make());
  const std::string path = folder->file("night.lcm");
  const MonoTime begun = mono_now();
  if (auto made = make_night_log(path, options.night); !made)
    return tl::make_unexpected(made.error());
  const double made_s = 1e-3 * ms_since(begun);
  DANCE_TRY(BenchReplayResult result, Run(options, path).run());
  result.made_s = made_s;
  return result;
}

}  // namespace dance
