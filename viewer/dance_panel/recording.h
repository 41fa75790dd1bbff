// DanceRecording: records the house's bus by `dance record`, as a program beside the window.
//
// Units/frames: MonoTime of this process.
// Ownership:    owns the program, which ends with it.
// Threads:      the drawing thread; nothing waits but the destructor, for a second at most.
// Failure:      trouble() says, in one printable line, why there is no recording, or why it ended.
#pragma once

#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/program/child_pipe.h"
#include "core/program/child_process.h"

namespace dance {

// "dance-2026-11-26-0815.lcm" for the ending ".lcm"; if that is taken, with a number before the
// ending. nullopt if all hundred names of this minute are taken.
std::optional<std::string> dance_file(const std::string& folder, const std::tm& local,
                                      std::string_view ending,
                                      const std::function<bool(const std::string&)>& is_taken);
// Returns the path for a new file. Creates the folder if it is missing.
Result<std::string> new_dance_file(const std::string& folder, std::string_view ending);
using Environment = std::function<const char*(const char*)>;
// The folder of recordings: DanceGraph in XDG_VIDEOS_DIR, else in ~/Videos. It may be missing.
// "" if HOME is not set.
std::string recordings_folder(const Environment& environment);
// The folders of earlier versions.
std::vector<std::string> older_recordings_folders(const Environment& environment);

class DanceRecording {
 public:
  struct Options {
    std::string program;  // of dance-record
    std::string folder;   // made where it is missing
    std::string bus;      // "" = the usual one
  };
  enum class State : std::uint8_t { kIdle, kRunning, kStopping };

  explicit DanceRecording(Options options) : options_(std::move(options)) {}
  DanceRecording(const DanceRecording&) = delete;
  DanceRecording& operator=(const DanceRecording&) = delete;

  void start(MonoTime now);
  void stop(MonoTime now);
  // Once a picture.
  void work(MonoTime now);

  State state() const { return state_; }
  Duration elapsed(MonoTime now) const {
    return state_ == State::kIdle ? Duration() : now - begun_;
  }
  // Of the one that runs, or ran last; "" before.
  const std::string& file() const { return file_; }
  // The last one ended well, and its file is there.
  bool is_saved() const { return is_saved_; }
  const std::string& trouble() const { return trouble_; }
  void forget_trouble() { trouble_.clear(); }

 private:
  void fail_with(std::string why);
  void read_words();
  void finish();

  Options options_;
  ChildPipe said_;  // outlives the program, which may write at its end
  std::optional<ChildProcess> program_;
  std::string words_;  // the program's last ones, as they came
  State state_ = State::kIdle;
  MonoTime begun_, asked_to_stop_;
  std::string file_;
  bool is_saved_ = false;
  std::string trouble_;
};

}  // namespace dance
