// A folder for the files of a run (sessions, what programs say), gone at its end.
//
// Units/frames: none.
// Ownership:    owns the folder and all in it.
// Threads:      one.
// Failure:      make() says that it cannot be made.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "core/base/result.h"

namespace dance {

class ScratchFolder {
 public:
  static Result<std::unique_ptr<ScratchFolder>> make() {
    std::string path = (std::filesystem::temp_directory_path() / "dance-bench-XXXXXX").string();
    if (!mkdtemp(path.data())) return fail(path + ": cannot be made; is TMPDIR writable?");
    return std::unique_ptr<ScratchFolder>(new ScratchFolder(path));
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

}  // namespace dance
