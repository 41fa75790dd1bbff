#include "viewer/replay/replay_feed.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "viewer/replay/state_bytes.h"

namespace dance {
namespace {

// So far ahead reading on costs less than a jump.
constexpr Duration kReadOn = Duration::s(1);
constexpr unsigned kMostThreads = 8;

void in_threads(std::size_t count, const std::function<void(std::size_t)>& work) {
  const std::size_t threads = std::min<std::size_t>(
      std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads), count);
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(run);
  run();
}

}  // namespace

Result<ReplayFeed> ReplayFeed::open(const std::string& path,
                                    std::shared_ptr<const ReplayIndex> index, GuestBoard& board) {
  DANCE_TRY(ReplayLog log, ReplayLog::open(path));
  return ReplayFeed(std::move(log), std::move(index), board);
}

ReplayFeed ReplayFeed::of(ReplayLog log, std::shared_ptr<const ReplayIndex> index,
                          GuestBoard& board) {
  return {std::move(log), std::move(index), board};
}

ReplayFeed::ReplayFeed(ReplayLog log, std::shared_ptr<const ReplayIndex> index, GuestBoard& board)
    : log_(std::move(log)),
      index_(std::move(index)),
      board_(&board),
      feed_(board, index_->wall_ahead_us) {}

// The newest wall time whose event is shown at that moment.
std::int64_t ReplayFeed::wall_us(MonoTime moment) const {
  const std::int64_t ns = moment.since_zero_ns();
  const std::int64_t us = ns / 1000 - (ns % 1000 < 0 ? 1 : 0);
  return us + index_->wall_ahead_us;
}

void ReplayFeed::show(MonoTime moment, InstrumentBoard* instruments) {
  if (!has_shown_ || moment < shown_ || moment - shown_ > kReadOn) {
    jump(moment);
    has_shown_ = true;
    shown_ = moment;
  } else {
    feed_.set_instruments(instruments);
    read_on_to(moment);
    feed_.set_instruments(nullptr);
  }
}

void ReplayFeed::read_on_to(MonoTime moment) {
  while (log_.step(wall_us(moment), feed_)) {
  }
  has_shown_ = true;
  shown_ = moment;
}

bool ReplayFeed::restore(const ReplayIndex::Checkpoint& checkpoint) {
  board_->clear(index_->clock_id);
  if (checkpoint.state.empty()) return true;
  StateReader reader(checkpoint.state);
  board_->carry(reader, [](const GuestId&, bool) { return false; });
  return reader.is_fine();
}

void ReplayFeed::jump(MonoTime moment) {
  const ReplayIndex::Checkpoint* from = &index_->checkpoint_for(moment);
  if (!restore(*from)) {
    from = &index_->checkpoints.front();
    board_->clear(index_->clock_id);
  }
  log_.jump(from->from_bytes, from->at_bytes, wall_us(moment), feed_, in_threads);
}

void ReplayFeed::show_from_the_beginning(MonoTime moment) {
  board_->clear(index_->clock_id);
  log_.rewind();
  read_on_to(moment);
}

}  // namespace dance
