// What the tests of dance music share: songs of clicks, an ear on BEAT/local, medians.
//
// Units/frames: seconds from the song's begin; times of this machine's clock.
// Ownership:    plain values; a BeatEar owns its bus.
// Threads:      none.
// Failure:      a bus that cannot be had fails the test.
#pragma once

#include <cmath>
#include <map>

#include "core/base/beat.h"
#include "tests/apps/bus_programs.h"
#include "tests/producers/music/wav_file.h"

namespace dance {

constexpr int kRate_hz = 44100;

// Beats of a band that sways, which no single tempo fits.
inline std::vector<double> uneven_beats(int count) {
  std::vector<double> times_s;
  double at_s = 0.25;
  for (int i = 0; i < count; ++i) {
    times_s.push_back(at_s);
    at_s += 0.5 + 0.04 * std::sin(1.7 * i);
  }
  return times_s;
}

inline std::vector<double> even_beats_at(double first_s, double period_s, int count) {
  std::vector<double> times_s;
  for (int i = 0; i < count; ++i) times_s.push_back(first_s + i * period_s);
  return times_s;
}

// All that was said on a house's BEAT/local.
class BeatEar {
 public:
  explicit BeatEar(const char* url) {
    auto bus = Bus::open(url);
    EXPECT_TRUE(bus) << bus.error().what;
    bus_ = std::move(*bus);
    bus_->subscribe<Beat>(Where::kLocal, [this](const Channel&, const Beat& beat, MonoTime) {
      said_.push_back(beat);
    });
  }
  void work() { bus_->drain(mono_now()); }
  const std::vector<Beat>& said() const { return said_; }
  std::size_t playing() const {
    return static_cast<std::size_t>(
        std::count_if(said_.begin(), said_.end(), [](const Beat& beat) { return beat.playing; }));
  }
  // When each beat was to be heard, as it was said last.
  std::map<int, MonoTime> beat_times() const {
    std::map<int, MonoTime> times;
    for (const Beat& beat : said_)
      if (beat.playing) times[static_cast<int>(beat.beat)] = beat.beat_time;
    return times;
  }

 private:
  std::unique_ptr<Bus> bus_;
  std::vector<Beat> said_;
};

inline double median(std::vector<double> values) {
  if (values.empty()) return 1e9;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

class MusicPrograms : public BusPrograms {
 protected:
  std::string make_song(const std::string& name, const std::vector<double>& beats_s, int bar) {
    const double length_s = beats_s.back() + 1.0;
    write_wav(folder_.path(name + ".wav"), click_track(beats_s, length_s, kRate_hz), 1, kRate_hz);
    std::ofstream list(folder_.path(name + ".beats"));
    list.precision(9);
    for (std::size_t i = 0; i < beats_s.size(); ++i)
      list << beats_s[i] << "\t" << static_cast<int>(i) % bar + 1 << "\n";
    return folder_.path(name + ".wav");
  }
  static std::string start_at(MonoTime t) { return std::to_string(t.since_zero_us()); }
  std::string talk() { return text_of(folder_.path("talk")); }
};

}  // namespace dance
