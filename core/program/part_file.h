// PartFile: the name that a file has until all of it is written: it becomes the file then, and is
// gone with this object unless it was kept.
//
// Units/frames: none.
// Ownership:    the file of that name, until it is kept.
// Threads:      none inside; one owner.
// Failure:      free_name() and keep() name the file and the cure.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "core/base/result.h"

namespace dance {

class PartFile {
 public:
  // An error where there is a file of that name.
  static Result<void> free_name(const std::string& to) {
    std::error_code unknown;
    if (std::filesystem::exists(std::filesystem::symlink_status(to, unknown)))
      return fail(to + ": is there already; remove it or choose another name");
    return {};
  }

  explicit PartFile(std::string to) : to_(std::move(to)), path_(to_ + ".part") {}
  ~PartFile() {
    std::error_code ignored;
    if (!is_kept_) std::filesystem::remove(path_, ignored);
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::string& path() const { return path_; }
  Result<void> keep() {
    std::error_code error;
    std::filesystem::rename(path_, to_, error);
    if (error) return fail(to_ + ": " + error.message() + "; choose another name");
    is_kept_ = true;
    return {};
  }

 private:
  std::string to_;
  std::string path_;
  bool is_kept_ = false;
};

}  // namespace dance
