// PartFile: the name that a file has until all of it is written: it becomes the file then, and is
// gone with this object unless it was kept.
//
// Units/frames: none.
// Ownership:    the file of that name, which it created, until it is kept.
// Threads:      none inside; one owner. Of a process's part files the first one is also removed
//               when SIGINT, SIGTERM or SIGHUP end it, where nobody else handles them.
// Failure:      create() and keep() name the file and the cure; neither touches a file of others.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"

namespace dance {

// Renames a file; an error where there is a file of the name `to`.
Result<void> move_to_free_name(const std::string& from, const std::string& to);

class PartFile {
 public:
  // Creates `to`.part, empty; an error where there is a file of either name.
  static Result<std::unique_ptr<PartFile>> create(const std::string& to);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::string& path() const { return path_; }
  // An error where there is a file of that name by now.
  Result<void> keep();

 private:
  explicit PartFile(std::string to) : to_(std::move(to)), path_(to_ + ".part") {}
  void forget();

  std::string to_;
  std::string path_;
  bool is_kept_ = false;
};

}  // namespace dance
