// Recorder: puts what is heard on a bus into an LCM log, as lcm-logger does, or into a packed one.
//
// Units/frames: event times are microseconds since 1970, which is what lcm-logplayer expects, as
//               core/net/clock/recording_clock.h gives them.
// Ownership:    owns the log file.
// Threads:      none inside; one owner.
// Failure:      make() names a file that cannot be written, or a pattern that is none; the first
//               write that fails (disk full) is kept in failure() and nothing is written after it.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "formats/log/log_file.h"
#include "formats/log/log_packer.h"

namespace dance {

// logs/2026-03-01-201530.lcm: where a recording goes unless it is named.
std::string default_log_path(std::chrono::system_clock::time_point now);

// Channel patterns as LCM reads them: regular expressions that have to match the whole name.
class RecordFilter {
 public:
  static Result<RecordFilter> make(const std::vector<std::string>& patterns);
  // True for every channel where there are no patterns.
  bool wants(std::string_view channel);

 private:
  std::vector<std::regex> patterns_;
  // Matching is slow beside a look-up; bounded, as anybody may make up channel names.
  std::map<std::string, bool, std::less<>> known_;
};

class Recorder {
 public:
  // What to do with a log that is there already.
  enum class IfThere { kRefuse, kAppend };
  enum class Poses { kPlain, kPacked };
  // Makes the folders of `path` where they are missing.
  static Result<Recorder> make(const std::string& path, RecordFilter filter,
                               IfThere if_there = IfThere::kRefuse, Poses poses = Poses::kPlain);

  void take(std::int64_t time_us, std::string_view channel, std::span<const std::uint8_t> data);
  // Gives everything to the system, so that a killed recorder loses only what came after.
  void flush();

  const std::optional<Error>& failure() const { return failure_; }
  const std::string& path() const { return path_; }
  std::uint64_t events() const { return writer_.events(); }
  std::uint64_t bytes() const { return writer_.bytes(); }
  // None where poses are plain.
  std::optional<LogPacker::Counters> packing() const;

 private:
  Recorder(std::string path, LogWriter writer, RecordFilter filter, Poses poses);
  void note(Result<void> written);

  std::string path_;
  LogWriter writer_;
  RecordFilter filter_;
  std::unique_ptr<LogPacker> packer_;
  std::optional<Error> failure_;
};

}  // namespace dance
