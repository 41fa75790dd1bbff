#include "viewer/feed/picture_source.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/net/mono_clock.h"
#include "viewer/replay/replay_source.h"

namespace dance {
namespace {

class LiveSource final : public PictureSource {
 public:
  explicit LiveSource(std::unique_ptr<StageFeed> feed)
      : feed_(std::move(feed)), begin_(mono_now()) {}

  GuestBoard& board() override { return feed_->board(); }
  InstrumentBoard& instruments() override { return feed_->instruments(); }
  DanceBoard* dance() override { return &feed_->dance(); }
  StepScoreBoard* step_scores() override { return &feed_->step_scores(); }
  MonoTime begin() const override { return begin_; }
  MonoTime wait_until(MonoTime moment) override {
    constexpr Duration kLook = Duration::ms(20);
    MonoTime now = mono_now();
    for (; now < moment && !feed_->is_over(); now = mono_now())
      std::this_thread::sleep_for(
          std::chrono::nanoseconds(std::min(moment - now, kLook).count_ns()));
    return now;
  }
  void report_shown(std::span<const StageRoster::Fresh> fresh, MonoTime swap_time) override {
    if (fresh.empty()) return;
    for (const StageRoster::Fresh& it : fresh)
      feed_->report_shown({it.guest,
                           {it.pose.clock_id, it.pose.sequence, it.pose.capture_time, it.pose.hops,
                            it.heard, swap_time}});
    feed_->wake();
  }
  bool is_over() const override { return feed_->is_over(); }
  const std::string& name() const override { return feed_->url(); }

 private:
  std::unique_ptr<StageFeed> feed_;
  MonoTime begin_;
};

}  // namespace

Result<std::unique_ptr<PictureSource>> PictureSource::open(const ViewOptions& options) {
  if (options.log.empty()) {
    DANCE_TRY(auto feed, StageFeed::create(options.feed));
    return std::make_unique<LiveSource>(std::move(feed));
  }
  DANCE_TRY(auto replay, ReplaySource::open(options));
  return replay;
}

}  // namespace dance
