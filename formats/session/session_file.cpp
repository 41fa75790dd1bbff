#include "formats/session/session_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/program/whole_file.h"

namespace dance {
Result<SessionFile> SessionFile::open(const std::string& path) {
  DANCE_TRY(std::string text, read_whole_file(path, kMaxSessionBytes));
  // What is no TOML is told now and not with the first save.
  if (const auto words = route_words(text, 0, path); !words)
    return tl::make_unexpected(words.error());
  return SessionFile(path, std::move(text));
}

std::vector<std::string> SessionFile::words(std::size_t route) const {
  return route_words(text_, route, path_).value_or(std::vector<std::string>());
}

std::optional<std::string> SessionFile::style(std::string_view guest) const {
  return style_words(text_, guest, path_).value_or(std::nullopt);
}

double SessionFile::music_volume() const { return dance::music_volume(text_, path_).value_or(1.0); }

Result<void> SessionFile::save(const SessionEdit& edit) {
  return change([&] { return edit_session(text_, edit, path_); });
}

Result<void> SessionFile::save_music_volume(double volume) {
  return change([&] { return set_music_volume(text_, volume, path_); });
}

OwnFigure SessionFile::figure(std::string_view guest) const {
  return own_figure(text_, guest, path_).value_or(OwnFigure());
}

bool SessionFile::hosts(std::string_view guest) const {
  const auto guests = own_guests(text_, path_);
  return guests && std::ranges::find(*guests, guest) != guests->end();
}

Result<void> SessionFile::save_shown_name(std::string_view guest, std::string_view name) {
  return change([&] { return set_own_name(text_, guest, name, path_); });
}

Result<void> SessionFile::save_figure(std::string_view guest, const OwnFigure& figure) {
  return change([&] { return set_own_figure(text_, guest, figure, path_); });
}

Result<void> SessionFile::save_voice(bool is_enabled) {
  return change([&] { return set_own_voice(text_, is_enabled, path_); });
}

template <class Edit>
Result<void> SessionFile::change(Edit edit) {
  // A folder that is ours would let us replace a file that is not to be written.
  if (access(path_.c_str(), W_OK) != 0)
    return fail(path_ + " cannot be written: " + std::strerror(errno) +
                "; chmod u+w it, or start the viewer with --session of a copy");
  DANCE_TRY(std::string now, read_whole_file(path_, kMaxSessionBytes));
  if (now != text_) {
    text_ = std::move(now);
    return fail(path_ + " was changed by somebody else; look at it, and save again to write there");
  }
  DANCE_TRY(std::string edited, edit());
  if (edited == text_) return {};
  if (auto written = write_whole_file(path_, edited); !written) return written;
  text_ = std::move(edited);
  return {};
}

}  // namespace dance
