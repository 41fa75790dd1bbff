// A recording of any kind as an LCM log, for players of logs: `dance view`, `dance replay`.
//
// Ownership:    of another kind than an LCM log a log without a name is written to the temporary
//               folder; it goes with this object.
// Failure:      open() names the file and the cure, or the temporary folder that is full.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "formats/recorded/recorded_file.h"

namespace dance {

class RecordingLog {
 public:
  static Result<RecordingLog> open(const std::string& path,
                                   const RecordedFileOptions& options = {});

  // A log to open while this object lives: the file itself, or the log that was made of it.
  const std::string& path() const { return path_; }
  bool is_made() const { return file_ != nullptr; }
  const std::vector<std::string>& notes() const { return notes_; }
  const std::string& lost() const { return lost_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;  // null for the file itself
  std::vector<std::string> notes_;
  std::string lost_;
};

}  // namespace dance
