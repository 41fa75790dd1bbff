// OutputFile: where a consumer writes to, a file or standard output. Keeps the first error and
// writes nothing after it, so that callers need not check each line.
//
// Ownership: closes the file it opened; standard output stays open.
// Threads:   none inside; one owner.
// Failure:   open() and flush() name the file and the reason (no such folder, disk full).
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

class OutputFile {
 public:
  // An empty path, or "-", is standard output.
  static Result<std::unique_ptr<OutputFile>> open(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);
  Result<void> flush();
  bool has_failed() const { return error_ != 0; }
  const std::string& name() const { return name_; }

 private:
  OutputFile(std::FILE* file, std::string name) : file_(file), name_(std::move(name)) {}

  std::FILE* file_;
  std::string name_;
  int error_ = 0;  // errno of the first failure
};

}  // namespace dance
