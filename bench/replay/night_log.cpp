#include "bench/replay/night_log.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>
#include <thread>
#include <vector>

#include "core/bus/encode.h"
#include "formats/log/log_file.h"
#include "producers/salsa/salsa_dancer.h"

namespace dance {
namespace {

constexpr std::uint64_t kNightClock = 7;
constexpr std::int64_t kWallAhead_us = 1'700'000'000'000'000;
constexpr int kFrames_hz = 60;
constexpr int kChunk_frames = 10 * kFrames_hz;
constexpr double kSong_s = 240.0;
constexpr double kBeats_hz = 3.0;
// A guest pauses so long, once in so long.
constexpr double kPause_s = 20.0;
constexpr double kPauseEvery_s = 420.0;

MonoTime night(double s) { return MonoTime() + Duration::seconds(500.0 + s); }
double beats_at(double s) { return kBeats_hz * std::fmod(s, kSong_s); }

// NightEvents in the order of their times.
class NightEvents {
 public:
  struct Item {
    std::int64_t time_us;
    const std::string* channel;
    std::size_t at, size;
  };

  void clear() { bytes_.clear(), items_.clear(); }
  void add(const LogEvent& event) {
    items_.push_back(
        {event.time_us, &*names_.emplace(event.channel).first, bytes_.size(), event.data.size()});
    bytes_.insert(bytes_.end(), event.data.begin(), event.data.end());
  }
  const std::vector<Item>& items() const { return items_; }
  std::span<const std::uint8_t> data_of(const Item& item) const {
    return std::span(bytes_).subspan(item.at, item.size);
  }

 private:
  std::set<std::string, std::less<>> names_;
  std::vector<std::uint8_t> bytes_;
  std::vector<Item> items_;
};

class NightSource {
 public:
  explicit NightSource(const NightWish& wish) : packer_(wish.intra_frame_period) {}
  virtual ~NightSource() = default;
  virtual void play(int frame, int until) = 0;
  NightEvents& events() { return events_; }

 protected:
  template <class Message>
  void write(MonoTime when, const Channel& channel, const Message& message) {
    MessageBuffer buffer;
    const std::size_t size = encode(message, buffer);
    events_.add(packer_.pack(
        {0, when.since_zero_us() + kWallAhead_us, channel.view(), {buffer.data(), size}}));
  }

 private:
  LogPacker packer_;
  NightEvents events_;
};

class NightMusic : public NightSource {
 public:
  using NightSource::NightSource;
  void play(int frame, int until) override {
    for (; frame < until; ++frame) {
      if (frame % 15 != 0) continue;
      const double s = static_cast<double>(frame) / kFrames_hz;
      Beat beat;
      beat.time = night(s);
      beat.clock_id = kNightClock;
      beat.beat = std::ceil(beats_at(s) + 0.01);
      beat.tempo_bpm = 60.0 * kBeats_hz;
      beat.beat_time = night(s) + Duration::seconds((beat.beat - beats_at(s)) / kBeats_hz);
      beat.beats_per_bar = 4;
      beat.confidence = 1.0f;
      beat.playing = true;
      write(night(s), Channel::of_house(Signal::kBeat), beat);
    }
  }
};

class NightGuest : public NightSource {
 public:
  NightGuest(const NightWish& wish, int number)
      : NightSource(wish),
        number_(number),
        has_arriving_(wish.has_arriving),
        id_(*GuestId::parse("guest-" + std::to_string(number + 1))),
        dancer_(style_of(number)) {}

  void play(int frame, int until) override {
    for (; frame < until; ++frame) {
      // Poses of one frame come spread over it.
      const double s = static_cast<double>(frame) / kFrames_hz + 0.00053 * number_;
      if (std::fmod(s + 37.0 * number_, kPauseEvery_s) >= kPause_s) dance(frame, s);
    }
  }

 private:
  static SalsaStyle style_of(int number) {
    SalsaStyle style;
    style.role = number % 2 == 0 ? SalsaRole::kLead : SalsaRole::kFollow;
    return style;
  }
  void dance(int frame, double s) {
    if (frame % kFrames_hz == number_ % kFrames_hz) {
      TimedSkeleton timed;
      timed.skeleton = dancer_.skeleton();
      timed.clock_id = kNightClock;
      timed.capture_time = night(s);
      write(night(s), Channel::of(Signal::kSkeleton, Where::kStage, id_), timed);
    }
    dancer_.dance_at(Duration::seconds(s), pose_);
    pose_.p_WH_m.x() += 2.0f * static_cast<float>(number_ / 2);
    pose_.clock_id = kNightClock;
    pose_.sequence = sequence_++;
    pose_.music_beats = beats_at(s);
    pose_.hops = {};
    pose_.capture_time = night(s - 0.055);
    pose_.stamp(Hop::kPublished, night(s - 0.030));
    pose_.stamp(Hop::kLinkReceived, night(s - 0.001));
    if (has_arriving_) write(night(s), Channel::of(Signal::kPose, Where::kGuest, id_), pose_);
    pose_.stamp(Hop::kStageTaken, night(s + 0.0001));
    pose_.stamp(Hop::kStaged, night(s + 0.0002));
    write(night(s + 0.0003), Channel::of(Signal::kPose, Where::kStage, id_), pose_);
  }

  int number_;
  bool has_arriving_;
  GuestId id_;
  SalsaDancer dancer_;
  Pose pose_;
  std::uint32_t sequence_ = 0;
};

void play_all(std::vector<std::unique_ptr<NightSource>>& sources, int frame, int until) {
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  const auto part = [&](std::size_t first) {
    for (std::size_t i = first; i < sources.size(); i += threads) {
      sources[i]->events().clear();
      sources[i]->play(frame, until);
    }
  };
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(part, i);
  part(0);
}

}  // namespace

Result<void> make_night_log(const std::string& path, const NightWish& wish) {
  DANCE_TRY(LogWriter log, LogWriter::create(path));
  std::vector<std::unique_ptr<NightSource>> sources;
  sources.push_back(std::make_unique<NightMusic>(wish));
  for (int i = 0; i < wish.guests; ++i) sources.push_back(std::make_unique<NightGuest>(wish, i));
  struct Next {
    const NightEvents* events;
    const NightEvents::Item* item;
  };
  std::vector<Next> order;
  std::int64_t number = 0;
  const int frames = static_cast<int>(std::lround(60.0 * wish.minutes * kFrames_hz));
  for (int frame = 0; frame < frames; frame += kChunk_frames) {
    play_all(sources, frame, std::min(frame + kChunk_frames, frames));
    order.clear();
    for (const auto& source : sources)
      for (const NightEvents::Item& item : source->events().items())
        order.push_back({&source->events(), &item});
    std::stable_sort(order.begin(), order.end(), [](const Next& a, const Next& b) {
      return a.item->time_us < b.item->time_us;
    });
    for (const Next& next : order)
      if (auto written = log.append({number++, next.item->time_us, *next.item->channel,
                                     next.events->data_of(*next.item)});
          !written)
        return written;
  }
  return log.flush();
}

}  // namespace dance
