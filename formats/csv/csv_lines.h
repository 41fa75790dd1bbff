// Reads a text file line by line in little memory.
//
// Ownership: owns the file; a line is valid until the next call.
// Threads:   none inside; one owner.
// Failure:   open() names the file and the reason; lines longer than kMostLine_bytes are left out
//            and counted. A read error is not an end: ended() reports it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

class CsvLines {
 public:
  static constexpr std::size_t kMostLine_bytes = std::size_t{1} << 16;

  static Result<CsvLines> open(const std::string& path);
  // Reads text in memory, which must outlive it.
  static CsvLines over(std::string_view text);

  // Without its line break.
  std::optional<std::string_view> next();
  Result<void> ended() const;
  std::uint64_t too_long() const { return too_long_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  CsvLines() = default;
  void fill();

  std::string name_;
  std::unique_ptr<std::FILE, CloseFile> file_;  // null when reading memory, and at the end
  std::string buffer_;
  std::string_view rest_;  // what was read and not returned yet
  bool is_skipping_ = false;
  int read_error_ = 0;  // errno
  std::uint64_t too_long_ = 0;
};

}  // namespace dance
