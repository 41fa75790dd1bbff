// ReplaySource: a recorded house as the source of pictures. Without a window it gives any moment,
// in the recording's own time. In a window a ReplayPlayer says which moment is shown, and the index
// is made in a thread meanwhile.
//
// Units/frames: headless, moments in the recorded house's clock; in a window the person's time.
// Ownership:    owns the board, the feed and the thread, which ends with it.
// Threads:      the drawing thread; the index is handed over by a finished thread.
// Failure:      open() names the log. In a window what goes wrong later is in note(), and the log
//               stays empty.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "viewer/feed/picture_source.h"
#include "viewer/replay/index_builder.h"
#include "viewer/replay/replay_feed.h"
#include "viewer/replay/replay_player.h"

namespace dance {

class ReplaySource final : public PictureSource {
 public:
  static Result<std::unique_ptr<ReplaySource>> open(const ViewOptions& options);
  ~ReplaySource() override;

  GuestBoard& board() override { return board_; }
  InstrumentBoard& instruments() override { return *instruments_; }
  MonoTime begin() const override;
  MonoTime wait_until(MonoTime moment) override;
  std::optional<MonoTime> time_of_beat(double beat) const override;
  Duration recorded() const override;
  bool is_over() const override { return is_over_; }
  const std::string& name() const override { return path_; }
  ReplaySource* replay() override { return this; }

  // nullptr until the log is looked through.
  ReplayPlayer* player() { return player_.get(); }
  const ReplayPlayer* player() const { return player_.get(); }
  std::shared_ptr<const ReplayIndex> index() const { return index_; }
  bool stage_only() const { return stage_only_; }
  // "reading the log: 43 %", or what went wrong; "" when all is well.
  std::string note() const;
  double progress() const { return progress_.load(std::memory_order_relaxed); }

 private:
  explicit ReplaySource(const ViewOptions& options);
  Result<IndexedLog> make_index(const ReadingProgress& goes_on) const;
  void start_reading();
  Result<void> take(Result<IndexedLog> indexed);
  void show(MonoTime moment);

  std::string path_;
  std::string log_to_read_;
  bool stage_only_;
  bool is_window_;
  GuestBoard board_;
  // Made anew in its place, as panels refer to it.
  std::optional<InstrumentBoard> instruments_{std::in_place, 0};
  std::shared_ptr<const ReplayIndex> index_;
  std::optional<ReplayFeed> feed_;
  std::unique_ptr<ReplayPlayer> player_;
  bool is_over_ = false;
  std::string failure_;
  MonoTime last_;  // of the person
  std::atomic<double> progress_{0.0};
  std::atomic<bool> is_read_{false};
  std::atomic<bool> asked_to_end_{false};
  Result<IndexedLog> read_ = fail("");
  std::thread thread_;
};

}  // namespace dance
