#include "voice/program/meter_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

namespace dance {
namespace {

constexpr std::size_t kUsualColumns = 80;
constexpr std::string_view kClearLine = "\r\033[K";

// All but the first byte of a character of UTF-8.
bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xc0u) == 0x80u; }

}  // namespace

std::string cut_to_columns(std::string_view text, std::size_t columns) {
  std::size_t characters = 0;
  std::size_t cut = 0;  // where the last character that fits begins
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (continues_character(text[i])) continue;
    if (++characters == columns) cut = i;
  }
  if (characters <= columns) return std::string(text);
  return columns == 0 ? std::string() : std::string(text.substr(0, cut)) + "…";
}

std::size_t MeterLine::columns() const {
  winsize size{};
  if (ioctl(fd_, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsualColumns;
  return size.ws_col;
}

void MeterLine::write(std::string_view text) const {
  // A terminal that takes no more has lost a picture of the levels.
  [[maybe_unused]] const ssize_t written = ::write(fd_, text.data(), text.size());
}

void MeterLine::show(std::string_view text) {
  // The last column stays free: terminals differ in where the cursor stands after it.
  write(std::string(kClearLine) + cut_to_columns(text, columns() - 1));
  is_shown_ = true;
}

void MeterLine::clear() {
  if (!is_shown_) return;
  write(kClearLine);
  is_shown_ = false;
}

}  // namespace dance
