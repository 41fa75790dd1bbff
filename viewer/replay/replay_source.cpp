#include "viewer/replay/replay_source.h"

#include <pthread.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "core/program/talk.h"

namespace dance {
namespace {

// The person's time begins somewhere.
constexpr MonoTime kPersonBegin = MonoTime::from_us(1'000'000);
// A window that was kept from drawing for long goes on where it was.
constexpr Duration kLongestPicture = Duration::ms(500);

// On a terminal one line that changes; in a file or pipe a line each tenth.
class ProgressLine {
 public:
  bool show(double share) {
    const int percent = static_cast<int>(share * 100.0);
    if (percent < shown_ + (is_terminal_ ? 1 : 10)) return true;
    shown_ = percent;
    std::fprintf(stderr, is_terminal_ ? "\rreading the log: %d %%" : "reading the log: %d %%\n",
                 percent);
    std::fflush(stderr);
    return true;
  }
  void end() const {
    if (is_terminal_ && shown_ >= 0) std::fprintf(stderr, "\r%30s\r", "");
  }

 private:
  bool is_terminal_ = isatty(STDERR_FILENO) == 1;
  int shown_ = is_terminal_ ? -1 : 0;
};

}  // namespace

ReplaySource::ReplaySource(const ViewOptions& options)
    : path_(options.log),
      log_to_read_(options.log_to_read()),
      stage_only_(options.feed.stage_only),
      is_window_(!options.headless),
      board_(0, options.feed.stage_only) {}

Result<std::unique_ptr<ReplaySource>> ReplaySource::open(const ViewOptions& options) {
  std::unique_ptr<ReplaySource> source(new ReplaySource(options));
  if (source->is_window_) {
    // What is no log at all is said before a window opens.
    DANCE_TRY([[maybe_unused]] const ReplayLog log, ReplayLog::open(options.log_to_read()));
    source->start_reading();
    return source;
  }
  ProgressLine line;
  auto indexed = source->make_index([&](double share) { return line.show(share); });
  line.end();
  if (auto taken = source->take(std::move(indexed)); !taken)
    return tl::make_unexpected(taken.error());
  return source;
}

ReplaySource::~ReplaySource() {
  asked_to_end_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

// The index of a temporary log, which was made for this run, is not saved.
Result<IndexedLog> ReplaySource::make_index(const ReadingProgress& goes_on) const {
  if (log_to_read_ == path_) return index_of_log(path_, stage_only_, goes_on);
  DANCE_TRY(ReplayIndex index, build_index(log_to_read_, stage_only_, goes_on));
  return IndexedLog{std::move(index), "", false};
}

void ReplaySource::start_reading() {
  thread_ = std::thread([this] {
    pthread_setname_np(pthread_self(), "view-index");
    read_ = make_index([this](double share) {
      progress_.store(share, std::memory_order_relaxed);
      return !asked_to_end_.load(std::memory_order_relaxed);
    });
    is_read_.store(true, std::memory_order_release);
  });
}

Result<void> ReplaySource::take(Result<IndexedLog> indexed) {
  if (!indexed) return tl::make_unexpected(indexed.error());
  if (!indexed->note.empty()) talk::warn("{}", indexed->note);
  index_ = std::make_shared<const ReplayIndex>(std::move(indexed->index));
  board_.clear(index_->clock_id);
  instruments_.emplace(index_->clock_id);
  auto feed = ReplayFeed::open(log_to_read_, index_, board_);
  if (!feed) return tl::make_unexpected(feed.error());
  feed_.emplace(std::move(*feed));
  player_ = std::make_unique<ReplayPlayer>(index_);
  return {};
}

// What is measured over time is measured anew after a jump.
void ReplaySource::show(MonoTime moment) {
  const std::uint32_t epoch = board_.epoch();
  feed_->show(moment, &*instruments_);
  if (board_.epoch() != epoch) instruments_.emplace(index_->clock_id);
}

MonoTime ReplaySource::begin() const { return is_window_ ? kPersonBegin : index_->begin; }

MonoTime ReplaySource::wait_until(MonoTime moment) {
  if (!is_window_) {
    show(moment);
    player_->set_playing(false);
    player_->go_to(moment);
    is_over_ = moment > index_->end;
    return moment;
  }
  const Duration passed = last_.is_set() ? moment - last_ : Duration();
  last_ = moment;
  if (!player_ && failure_.empty() && is_read_.load(std::memory_order_acquire)) {
    thread_.join();
    if (auto taken = take(std::move(read_)); !taken) failure_ = taken.error().what;
  }
  if (!player_) return moment;
  player_->advance(std::min(passed, kLongestPicture));
  show(player_->position());
  return player_->position();
}

std::optional<MonoTime> ReplaySource::time_of_beat(double beat) const {
  return index_ ? index_->time_of_beat(beat) : std::nullopt;
}

Duration ReplaySource::recorded() const {
  return index_ ? index_->end - index_->begin : Duration();
}

std::string ReplaySource::note() const {
  if (!failure_.empty()) return failure_;
  if (player_) return "";
  return "reading the log: " + std::to_string(static_cast<int>(progress() * 100.0)) + " %";
}

}  // namespace dance
