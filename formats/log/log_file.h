// LCM log files, with a bounded reader, as liblcm's trusts the lengths in a damaged file. The
// format is LCM's, so lcm-logger, lcm-logplayer and these are interchangeable.
//
// Units/frames: event times are microseconds of the recorder's wall clock.
// Ownership:    a reader's events are valid until its next call.
// Threads:      none inside; one owner.
// Failure:      open() and append() name the file and the reason; damaged bytes are skipped to the
//               next event and counted. A read error is not an end: ended() reports it.
// Source:       LCM documentation, "Log file format": big-endian sync word 0xEDA1DA01, event
//               number, time, lengths, channel, data.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dance {

// The header of an event.
constexpr std::size_t kLogHeader_bytes = 28;

struct LogEvent {
  std::int64_t number = 0;  // as counted by its recorder
  std::int64_t time_us = 0;
  std::string_view channel;
  std::span<const std::uint8_t> data;

  // Its size in a file.
  std::size_t stored_bytes() const { return kLogHeader_bytes + channel.size() + data.size(); }
};

class LogReader {
 public:
  static Result<LogReader> open(const std::string& path);
  // Takes over an open file.
  static LogReader of(std::FILE* file, std::string name);
  // Reads bytes in memory, which must outlive the reader.
  static LogReader over(std::span<const std::uint8_t> bytes);

  // The next complete event; nullopt at the end of the file or a read error.
  std::optional<LogEvent> next();
  // After the last event: success at the end of the file, else the read error.
  Result<void> ended() const;
  // Goes back to the beginning and resets the count of skipped bytes.
  void rewind() {
    seek(0);
    skipped_bytes_ = 0;
  }
  // Goes on with the first event at or after that place.
  void seek(std::uint64_t at_bytes);
  // next() gives the last event once more.
  void again() { pending_ = 0; }
  // Where in the file the last event is, and where its next is looked for.
  std::uint64_t event_at_bytes() const { return buffer_at_ + begin_; }
  std::uint64_t next_at_bytes() const { return buffer_at_ + begin_ + pending_; }

  // Bytes outside complete events: damage, or a truncated log.
  std::uint64_t skipped_bytes() const { return skipped_bytes_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  LogReader() = default;
  bool fill(std::size_t wanted);
  bool reaches_into_another(std::size_t whole);
  void skip(std::size_t count);

  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;  // null when reading memory
  std::span<const std::uint8_t> memory_;
  std::size_t memory_at_ = 0;
  std::vector<std::uint8_t> buffer_;
  std::uint64_t buffer_at_ = 0;  // in the file
  std::size_t begin_ = 0;        // of unread bytes in buffer_
  std::size_t pending_ = 0;      // bytes of the event returned last
  bool at_end_ = false;
  int read_error_ = 0;  // errno
  std::uint64_t skipped_bytes_ = 0;
};

class LogWriter {
 public:
  // Creates a file; an existing one is refused.
  static Result<LogWriter> create(const std::string& path);
  // Appends to a file, or creates it. A truncated event before costs no other: readers search for
  // the next one.
  static Result<LogWriter> append_to(const std::string& path);
  // Numbered by the count of this writer's events.
  Result<void> append(std::int64_t time_us, std::string_view channel,
                      std::span<const std::uint8_t> data);
  // With its own number, for copies of logs.
  Result<void> append(const LogEvent& event);
  Result<void> flush();
  std::uint64_t events() const { return static_cast<std::uint64_t>(events_); }
  std::uint64_t bytes() const { return bytes_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  LogWriter() = default;
  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::int64_t events_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace dance
