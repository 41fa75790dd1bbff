#include "formats/csv/csv_lines.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "core/base/take_line.h"

namespace dance {
namespace {

std::string reason_of(int error) { return std::generic_category().message(error); }

}  // namespace

Result<CsvLines> CsvLines::open(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return fail(path + ": is a folder, not a table; name a file in it");
  CsvLines lines;
  lines.name_ = path;
  lines.file_.reset(std::fopen(path.c_str(), "rbe"));
  if (!lines.file_) return fail(path + ": " + reason_of(errno));
  return lines;
}

CsvLines CsvLines::over(std::string_view text) {
  CsvLines lines;
  lines.rest_ = text;
  return lines;
}

Result<void> CsvLines::ended() const {
  if (read_error_ == 0) return {};
  return fail(name_ + ": cannot be read to its end: " + reason_of(read_error_) +
              "; copy what can be had of it to another disk");
}

// More of the file behind what is left.
void CsvLines::fill() {
  std::string kept(rest_);
  const std::size_t has = kept.size();
  kept.resize(has + kMostLine_bytes);
  const std::size_t got = std::fread(kept.data() + has, 1, kMostLine_bytes, file_.get());
  kept.resize(has + got);
  if (got < kMostLine_bytes) {
    if (std::ferror(file_.get())) read_error_ = errno;
    file_.reset();
  }
  buffer_ = std::move(kept);
  rest_ = buffer_;
}

std::optional<std::string_view> CsvLines::next() {
  for (;;) {
    const bool has_break = rest_.find('\n') != std::string_view::npos;
    if (!has_break && file_) {
      if (rest_.size() > kMostLine_bytes) {  // what is left of it is skipped as well
        is_skipping_ = true;
        rest_ = {};
      }
      fill();
      continue;
    }
    if (rest_.empty()) return std::nullopt;
    const std::string_view line = take_line(rest_);
    if (!is_skipping_ && line.size() <= kMostLine_bytes) return line;
    is_skipping_ = false;
    ++too_long_;
  }
}

}  // namespace dance
