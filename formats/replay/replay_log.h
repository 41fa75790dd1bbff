// ReplayLog: reads what a stage shows out of an LCM log, packed or plain, from any checkpoint on:
// poses, hands, proportions, states and beats of capture and stage. Most packed poses that lie
// before the moment asked for are only glanced at, which costs a fortieth of unpacking them.
//
// Units/frames: event times are microseconds of the recorder's wall clock.
// Ownership:    owns the file; a sink's arguments are valid during the call.
// Threads:      none inside; jump() lets the caller run the unpacking of its channels in several.
// Failure:      open() names the file; damage is skipped and counted. After damage a channel
//               resumes with its next intra frame. Of a read error ended() tells.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/bus/channel.h"
#include "core/pose/pose.h"
#include "formats/log/log_file.h"
#include "formats/log/motion_stream.h"
#include "formats/log/packed_event.h"

namespace dance {

// What a stage shows: poses, hands and proportions of capture and stage, poses that came into the
// house, states, beats, chat.
bool is_shown(const Channel& channel);

class ReplaySink {
 public:
  virtual ~ReplaySink() = default;
  // `is_passed`: others of this channel follow before anything is shown.
  virtual void on_message(const Channel& channel, std::span<const std::uint8_t> message,
                          std::int64_t time_us, bool is_passed) = 0;
  // A packed pose without its body, or packed hands (nullptr), of which others follow.
  virtual void on_glance(const Channel& channel, const Pose* pose, std::int64_t time_us) = 0;
};

class ReplayLog {
 public:
  // Calls work(0) … work(count − 1), in any order, in as many threads as it likes.
  using ForEach =
      std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

  static constexpr std::size_t kMostChannels = 512;

  static Result<ReplayLog> open(const std::string& path);
  // Reads bytes in memory, which must outlive it.
  static ReplayLog over(std::span<const std::uint8_t> bytes);

  // To the beginning, as a log that was just opened.
  void rewind();
  // Glances at the next event that a stage shows; false at the end.
  bool look(ReplaySink& sink);
  // Of what was looked at: where in the file the event begins, where the next is looked for, and
  // from where the packed channels that were in use at `now_us` have to be read.
  std::uint64_t event_at_bytes() const { return reader_.event_at_bytes(); }
  std::uint64_t next_at_bytes() const { return reader_.next_at_bytes(); }
  std::uint64_t needed_from_bytes(std::int64_t now_us) const;

  // Tells the next event of any channel of ours, unpacked, if it is not later than until_us; false
  // when there is none.
  bool step(std::int64_t until_us, ReplaySink& sink);
  // Tells what came from at_bytes up to until_us, the first later one excepted, so that each
  // guest's last pose and its hands are whole; step() goes on from there.
  void jump(std::uint64_t from_bytes, std::uint64_t at_bytes, std::int64_t until_us,
            ReplaySink& sink, const ForEach& for_each);

  Result<void> ended() const { return reader_.ended(); }
  std::uint64_t damaged() const { return damaged_; }

 private:
  struct Line {
    explicit Line(const Channel& which) : channel(which), shown(is_shown(which)) {}
    Channel channel;
    bool shown;
    MotionGlance glance;
    std::unique_ptr<MotionUnpacker> unpacker;  // of packed channels, once they are unpacked
    std::uint64_t key_at_bytes = 0;            // of its last intra frame
    std::int64_t heard_us = 0;
    bool is_packed = false;
    MessageBuffer message;
  };
  // What jump() has read.
  struct Item {
    Line* line;
    std::int64_t time_us;
    std::size_t at, size;  // in bytes_
    std::uint32_t checksum;
    bool is_packed, is_key, is_before;
    std::optional<std::size_t> whole;  // where it is in the line's `unpacked`
  };
  struct Chain {
    Line* line = nullptr;
    std::vector<std::size_t> items;
    std::vector<std::vector<std::uint8_t>> unpacked;
  };

  explicit ReplayLog(LogReader reader) : reader_(std::move(reader)) {}
  Line* line_of(std::string_view channel);
  bool tell_glance(Line& line, const PackedMotion& motion, std::int64_t time_us, ReplaySink& sink);
  std::span<const std::uint8_t> unpack(Line& line, bool is_key, std::uint32_t checksum,
                                       std::span<const std::uint8_t> packed);
  void read_items(std::uint64_t at_bytes, std::int64_t until_us);
  void unpack_chain(Chain& chain, std::size_t target);
  std::size_t target_of(const Chain& chain) const;

  LogReader reader_;
  std::map<std::string, std::unique_ptr<Line>, std::less<>> lines_;
  std::uint64_t damaged_ = 0;
  // Of a jump; kept, as their memory is used again.
  std::vector<std::uint8_t> bytes_;
  std::vector<Item> items_;
};

}  // namespace dance
