#include "viewer/feed/picture_source.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/net/mono_clock.h"
#include "viewer/feed/log_feed.h"

namespace dance {
namespace {

class LiveSource final : public PictureSource {
 public:
  explicit LiveSource(std::unique_ptr<StageFeed> feed)
      : feed_(std::move(feed)), begin_(mono_now()) {}

  GuestBoard& board() override { return feed_->board(); }
  InstrumentBoard& instruments() override { return feed_->instruments(); }
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

class RecordedSource final : public PictureSource {
 public:
  RecordedSource(LogFeed feed, std::string name, bool repeats)
      : feed_(std::move(feed)), name_(std::move(name)), repeats_(repeats) {}

  GuestBoard& board() override { return feed_.board(); }
  InstrumentBoard& instruments() override { return feed_.instruments(); }
  MonoTime begin() const override { return feed_.begin(); }
  MonoTime wait_until(MonoTime moment) override {
    feed_.go_on_to(moment);
    while (repeats_ && moment > feed_.end()) {
      feed_.begin_again();
      feed_.go_on_to(moment);
    }
    is_over_ = moment > feed_.end();
    return moment;
  }
  std::optional<MonoTime> time_of_beat(double beat) const override {
    return feed_.time_of_beat(beat);
  }
  Duration recorded() const override { return feed_.end() - feed_.begin(); }
  bool is_over() const override { return is_over_; }
  const std::string& name() const override { return name_; }

 private:
  LogFeed feed_;
  std::string name_;
  bool repeats_ = false;
  bool is_over_ = false;
};

}  // namespace

Result<std::unique_ptr<PictureSource>> PictureSource::open(const ViewOptions& options) {
  if (options.log.empty()) {
    DANCE_TRY(auto feed, StageFeed::create(options.feed));
    return std::make_unique<LiveSource>(std::move(feed));
  }
  DANCE_TRY(LogFeed feed, LogFeed::open(options.log, options.feed.stage_only));
  return std::make_unique<RecordedSource>(std::move(feed), options.log, !options.headless);
}

}  // namespace dance
