// VoicePlayout: packets of one guest, as they come, to sound without gaps: waits as long as the
// line's jitter makes necessary and no longer, stretches speech to change that, conceals what does
// not come, and follows the sender's sound card.
//
// Units/frames: samples at 48 kHz, mono; times of this house's clock. A delay is from a frame's
//               capture until its first sample is heard.
// Ownership:    owns decoder and packets (kMostFrames of them); allocates nothing after
//               construction.
// Threads:      none inside; one owner.
// Failure:      late, double and bad packets are counted; none stops the sound.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "core/bus/voice.h"
#include "voice/codec/voice_decoder.h"
#include "voice/playout/arrival_delays.h"

namespace dance {

class VoicePlayout {
 public:
  static constexpr std::size_t kMostFrames = 512;

  struct Counters {
    std::uint64_t received = 0;
    std::uint64_t late = 0;       // its moment had passed
    std::uint64_t duplicate = 0;  // was there already
    std::uint64_t played = 0;     // frames of speech, with those below
    std::uint64_t concealed = 0;  // made up
    std::uint64_t recovered = 0;  // from the copy in the packet after
    std::uint64_t skipped = 0;    // left out, as too much had gathered
    std::uint64_t lengthened_samples = 0;
    std::uint64_t shortened_samples = 0;
  };

  explicit VoicePlayout(std::unique_ptr<VoiceDecoder> decoder) : decoder_(std::move(decoder)) {}

  void put(const Voice& voice, MonoTime arrival);
  // What comes next is another guest's, with counters from zero.
  void forget();
  // The next samples; the first of them is heard at `heard`.
  void pull(MonoTime now, MonoTime heard, std::span<float> samples);
  // Not earlier than so long after capture: as late as the guest's picture. None: as soon as can
  // be.
  void set_delay(std::optional<Duration> after_capture) { delay_ = after_capture; }

  bool is_speaking() const { return is_speaking_; }
  // Of what is played now; below it what the jitter of the line makes necessary.
  std::optional<Duration> delay() const;
  Duration jitter_wait() const { return delays_.wait(); }
  const Counters& counters() const { return counters_; }
  std::uint64_t bad_packets() const { return decoder_->bad_packets(); }

 private:
  struct Slot {
    std::int64_t frame = -1;
    std::uint8_t size = 0;
    std::array<std::uint8_t, kMaxVoiceBytes> data{};

    std::span<const std::uint8_t> packet() const { return std::span(data).first(size); }
  };
  static constexpr std::size_t kHistory = 720;
  static constexpr std::size_t kAhead = 2400;

  std::int64_t unwrapped(std::uint32_t sequence);
  void restart();
  const Slot* find(std::int64_t frame) const;
  std::optional<std::int64_t> oldest_from(std::int64_t frame) const;
  void note_gap(std::int64_t frame, MonoTime arrival);
  Duration wanted_margin(MonoTime now, MonoTime heard) const;
  // By how much later than the quickest arrival the next frame is played.
  Duration margin(MonoTime now) const;
  void note_burst(MonoTime now, std::size_t samples);
  void produce(MonoTime now, MonoTime heard);
  void produce_silence(MonoTime now, MonoTime heard);
  void produce_frame();
  void produce_lost();
  bool leave_out_gap(MonoTime now, MonoTime heard);
  void append(std::span<const float> samples);
  void keep_time(MonoTime now, MonoTime heard);
  void skip_to(std::int64_t frame);

  std::unique_ptr<VoiceDecoder> decoder_;
  ArrivalDelays delays_;
  std::array<Slot, kMostFrames> slots_{};
  std::optional<Duration> delay_;
  std::optional<std::uint32_t> newest_sequence_;
  std::int64_t newest_ = 0;
  std::int64_t next_ = 0;    // frame to be decoded
  MonoTime capture_origin_;  // capture time of frame 0, smoothed
  bool has_origin_ = false;
  std::optional<Duration> heard_delay_;
  bool is_speaking_ = false;
  // Of the packets of the last seconds, the share that came behind one that had not, whose copy
  // they bring; whether they are worth waiting for, and how long that takes.
  double copies_share_ = 0.0;
  bool waits_for_copies_ = false;
  double copies_wait_ms_ = 0.0;
  int concealed_in_a_row_ = 0;
  int strangers_in_a_row_ = 0;
  double margin_error_ms_ = 0.0;  // smoothed
  // Of sound that is asked for at one moment.
  MonoTime pulled_;
  double burst_now_ms_ = 0.0;
  double burst_ms_ = 0.0;
  // What was played last, and what is to be played next.
  std::array<float, kHistory + kAhead> line_{};
  std::size_t ready_ = 0;  // behind the history
  Counters counters_;
};

}  // namespace dance
