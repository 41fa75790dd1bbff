#include "testing/xr/script/xr_record.h"

namespace dance::test_xr {

void XrRecord::open(const std::string& path) {
  close();
  if (path.empty()) return;
  const std::lock_guard lock(mutex_);
  file_ = std::fopen(path.c_str(), "ae");
  if (!file_) std::fprintf(stderr, "%s: cannot be written; see DANCE_XR_RECORD\n", path.c_str());
}

void XrRecord::close() {
  const std::lock_guard lock(mutex_);
  if (file_) std::fclose(file_);
  file_ = nullptr;
}

void XrRecord::line(const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (!file_) return;
  std::fprintf(file_, "%s\n", text.c_str());
  std::fflush(file_);
}

}  // namespace dance::test_xr
