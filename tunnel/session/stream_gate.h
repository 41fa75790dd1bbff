// Newest wins: decides for each record of one guest whether it goes on. Each guest has its own
// sequence, so no dancer's datagram can hold up another's. A later stream (the producer or the link
// began anew) replaces the earlier one for good. Counts what is missing, and takes it back where it
// was only late.
//
// Sequences alone could be stuck for good behind one damaged number that leapt ahead. Capture times
// heal that: what is a second newer goes on whatever its numbers say, and what is a second older
// does not.
//
// Units/frames: sequences and streams are 32 bit and wrap; capture times of one clock, never far
//               from now (the caller sees to it).
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; counters() tells every record's end.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/sequence.h"

namespace dance {

class StreamGate {
 public:
  enum class Verdict : std::uint8_t { kNewest, kNewStream, kLate, kDuplicate, kOldStream };
  struct Counters {
    std::uint64_t received = 0;  // went on
    std::uint64_t lost = 0;      // gaps, less what was not sent and what arrived late
    std::uint64_t late = 0;      // a newer one was there already, or of a stream that has ended
    std::uint64_t duplicate = 0;
  };

  // `left_out`: how many of this generation were not sent to us so far, as told with the record;
  // nothing = as many as were told last.
  Verdict judge(std::uint32_t stream, std::uint32_t sequence, std::int64_t capture_us = 0,
                std::optional<std::uint16_t> left_out = {}) {
    const std::int64_t ahead_us = capture_us - newest_capture_us_;
    if (has_any_ && ahead_us < -kTrustedNumbers_us) {
      ++counters_.late;
      return Verdict::kLate;
    }
    const std::int32_t ahead = sequence_ahead(newest_, sequence);
    const bool is_next = has_any_ && stream == stream_ && ahead > 0;
    const bool is_new_stream =
        !has_any_ || (stream != stream_ && is_newer_sequence(stream, stream_));
    if (is_new_stream || (!is_next && ahead_us > kTrustedNumbers_us)) {
      has_any_ = true;
      stream_ = stream;
      newest_ = sequence;
      newest_capture_us_ = capture_us;
      seen_ = ~std::uint64_t{0};  // what was before the first is not missed
      left_out_ = left_out.value_or(left_out_);
      gap_is_exempt_ = false;
      ++counters_.received;
      return Verdict::kNewStream;
    }
    if (stream != stream_) {
      ++counters_.late;
      return Verdict::kOldStream;
    }
    if (is_next) {
      newest_capture_us_ = capture_us;
      // Bit i of seen_: newest_ − i came.
      seen_ = ahead < 64 ? seen_ << ahead | 1 : 1;
      newest_ = sequence;
      count_gap(static_cast<std::uint64_t>(ahead) - 1, left_out.value_or(left_out_));
      ++counters_.received;
      return Verdict::kNewest;
    }
    return judge_old(ahead);
  }

  // Low bits of a sequence that came late may read as ahead: then it was captured well before the
  // newest.
  bool contradicts(std::uint32_t sequence, std::int64_t capture_us) const {
    constexpr std::int64_t kBefore_us = 100'000;
    return has_any_ && sequence_ahead(newest_, sequence) > 0 &&
           capture_us < newest_capture_us_ - kBefore_us;
  }

  // The newest was sent from store: what lies between it and the next is not missed.
  void exempt_gap() { gap_is_exempt_ = true; }

  bool has_any() const { return has_any_; }
  std::uint32_t stream() const { return stream_; }
  std::uint32_t newest() const { return newest_; }
  const Counters& counters() const { return counters_; }

 private:
  static constexpr std::int64_t kTrustedNumbers_us = 1'000'000;

  void count_gap(std::uint64_t gap, std::uint16_t left_out) {
    const std::uint64_t not_sent = static_cast<std::uint16_t>(left_out - left_out_);
    left_out_ = left_out;
    if (!gap_is_exempt_ && gap > not_sent) counters_.lost += gap - not_sent;
    gap_is_exempt_ = false;
  }

  Verdict judge_old(std::int32_t ahead) {
    if (ahead > -64) {
      const std::uint64_t bit = std::uint64_t{1} << -ahead;
      if ((seen_ & bit) != 0) {
        ++counters_.duplicate;
        return Verdict::kDuplicate;
      }
      seen_ |= bit;
      if (counters_.lost > 0) --counters_.lost;
    }
    ++counters_.late;
    return Verdict::kLate;
  }

  bool has_any_ = false;
  std::uint32_t stream_ = 0;
  std::uint32_t newest_ = 0;
  std::int64_t newest_capture_us_ = 0;
  std::uint64_t seen_ = 0;
  std::uint16_t left_out_ = 0;
  bool gap_is_exempt_ = false;
  Counters counters_;
};

}  // namespace dance
