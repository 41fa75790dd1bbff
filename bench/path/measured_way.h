// The paths that BenchPath compares: Way counts and times the messages of one path. LcmEnd is one
// end of the path over LCM's library.
//
// Failure: LcmEnd::is_open() is false if LCM cannot open the bus.
#pragma once

#include <lcm/lcm.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>

#include "bench/path/bench_path.h"
#include "core/bus/encode.h"
#include "core/net/poller.h"

namespace dance {

// One path from a bus to another: counts the messages that are sent and times those that arrive.
// Messages are numbered. Each counts for the stretch of the run in which it was sent: quiet,
// flooded or none.
class Way {
 public:
  enum class Stretch : std::uint8_t { kNone, kQuiet, kFlooded };

  std::uint32_t send(MonoTime now) {
    sent_[sequence_ % sent_.size()] = {now, stretch_};
    if (WayResult* result = result_of(stretch_)) ++result->sent;
    return sequence_++;
  }
  void arrived(std::uint32_t sequence, MonoTime now) {
    ++arrived_;
    const std::uint32_t back = sequence_ - 1 - sequence;
    if (back >= sent_.size()) return;
    const Sent& sent = sent_[sequence % sent_.size()];
    if (WayResult* result = result_of(sent.stretch)) result->took.push_back(now - sent.at);
  }
  void expect(std::size_t messages) {
    for (WayResult& result : results_) result.took.reserve(messages + 64);
  }
  void begin(Stretch stretch) { stretch_ = stretch; }
  bool is_open() const { return arrived_ > 0; }
  bool is_measuring() const { return stretch_ == Stretch::kQuiet; }
  WayResult result(Stretch stretch) {
    WayResult sorted = *result_of(stretch);
    std::sort(sorted.took.begin(), sorted.took.end());
    return sorted;
  }

 private:
  struct Sent {
    MonoTime at;
    Stretch stretch = Stretch::kNone;
  };
  WayResult* result_of(Stretch stretch) {
    return stretch == Stretch::kNone ? nullptr : &results_[stretch == Stretch::kQuiet ? 0 : 1];
  }

  std::array<Sent, 4096> sent_{};
  std::uint32_t sequence_ = 1;
  std::uint64_t arrived_ = 0;
  Stretch stretch_ = Stretch::kNone;
  std::array<WayResult, 2> results_;
};

// The two ends of the floor that LCM's library carries.
class LcmEnd {
 public:
  static constexpr const char* kChannel = "BENCH/floor";
  using Handler = std::function<void(const void* data, std::size_t size)>;
  explicit LcmEnd(const std::string& url) : lcm_(lcm_create(url.c_str())) {}
  ~LcmEnd() {
    if (lcm_ != nullptr) lcm_destroy(lcm_);
  }
  LcmEnd(const LcmEnd&) = delete;
  LcmEnd& operator=(const LcmEnd&) = delete;

  bool is_open() const { return lcm_ != nullptr; }
  void publish(const MessageBuffer& message, std::size_t size) {
    lcm_publish(lcm_, kChannel, message.data(), static_cast<unsigned>(size));
  }
  void listen(Poller& poller, Handler handler) {
    handler_ = std::move(handler);
    lcm_subscribe(lcm_, kChannel, on_message, this);
    poller.watch(lcm_get_fileno(lcm_), [this](MonoTime) {
      while (lcm_handle_timeout(lcm_, 0) > 0) continue;
    });
  }

 private:
  static void on_message(const lcm_recv_buf_t* message, const char*, void* self) {
    static_cast<LcmEnd*>(self)->handler_(message->data, message->data_size);
  }
  lcm_t* lcm_;
  Handler handler_;
};

}  // namespace dance
