// StageFeed: receives what the viewer shows: the house's bus on a thread of its own, because the
// window system wants the main thread. It fills a GuestBoard, and publishes when each pose was
// shown.
//
// Units/frames: MonoTime of this process.
// Ownership:    owns bus, poll loop and thread; the destructor ends the thread.
// Threads:      create() before any other thread starts (signals); board().take(), report_shown()
//               and is_over() on the drawing thread; the rest happens on the bus thread.
// Failure:      create() names the bus and the reason.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "core/base/spsc_ring.h"
#include "core/bus/bus.h"
#include "core/control/house_publisher.h"
#include "core/net/poller.h"
#include "viewer/dance_panel/dance_board.h"
#include "viewer/feed/guest_board.h"
#include "viewer/instruments/instrument_board.h"
#include "viewer/practice/step_score_board.h"

namespace dance {

// Which poses are shown.
enum class Shown { kBest, kCapture, kGuest, kStage };

struct FeedOptions {
  std::string bus_url;
  Shown shown = Shown::kBest;
  bool stage_only = false;
};

// A pose that has been on the screen since swap_time.
struct ShownPose {
  GuestId guest;
  StageTime time;
};

class StageFeed {
 public:
  static Result<std::unique_ptr<StageFeed>> create(const FeedOptions& options);
  ~StageFeed();
  StageFeed(const StageFeed&) = delete;
  StageFeed& operator=(const StageFeed&) = delete;

  GuestBoard& board() { return board_; }
  InstrumentBoard& instruments() { return instruments_; }
  DanceBoard& dance() { return dance_; }
  StepScoreBoard& step_scores() { return step_scores_; }
  const std::string& url() const { return bus_->url(); }
  void report_shown(const ShownPose& shown) { shown_.push(shown); }
  // After the last report_shown() of a picture.
  void wake();
  // True when SIGINT or SIGTERM has come.
  bool is_over() const { return over_.load(std::memory_order_acquire); }

 private:
  explicit StageFeed(const FeedOptions& options);
  void subscribe(const FeedOptions& options);
  void measure(const FeedOptions& options);
  void hear_house();
  void count_steps();
  void publish_asked();
  void publish_figures(MonoTime now);
  void publish_counters(MonoTime now);
  void publish_hidden(MonoTime now);
  void publish_recording(MonoTime now);
  void run();
  void on_wake();

  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<HousePublisher> port_;  // bus and houses
  GuestBoard board_;
  InstrumentBoard instruments_;
  DanceBoard dance_;
  StepScoreBoard step_scores_;
  InterestWish hidden_;       // as published last
  RecordingState recording_;  // as published last
  MonoTime room_song_at_;     // when the room's song arrived last
  MonoTime room_music_at_;    // when the room's music did
  MonoTime begin_, counted_;
  std::int64_t shown_count_ = 0;
  SpscRing<ShownPose, 512> shown_;
  int wake_fd_ = -1;
  std::atomic<bool> asked_to_end_{false};
  std::atomic<bool> over_{false};
  std::thread thread_;
};

}  // namespace dance
