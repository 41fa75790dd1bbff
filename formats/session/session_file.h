// SessionFile: the session file of the house that a viewer shows, for what its panels save.
//
// Units/frames: none.
// Ownership:    keeps the text as it was read, to tell whether somebody else has changed it.
// Threads:      one owner.
// Failure:      save() changes nothing where the file cannot be written, where it was changed since
//               it was read, or where its text has no place for the values; the error says which,
//               and the cure.
#pragma once

#include <string>

#include "formats/session/own_edit.h"
#include "formats/session/session_edit.h"

namespace dance {

class SessionFile {
 public:
  static Result<SessionFile> open(const std::string& path);

  const std::string& path() const { return path_; }
  // Writes the values into the file; a reader meanwhile sees the old file or the new one.
  Result<void> save(const SessionEdit& edit);
  Result<void> save_music_volume(double volume);
  double music_volume() const;
  // These read and save the choices of a guest of this house. An unknown guest is an error.
  OwnFigure figure(std::string_view guest) const;
  bool hosts(std::string_view guest) const;
  Result<void> save_shown_name(std::string_view guest, std::string_view name);
  Result<void> save_figure(std::string_view guest, const OwnFigure& figure);
  // [voice] as a whole; its other keys stay.
  Result<void> save_voice(bool is_enabled);
  // The words of a route as they stand in the file.
  std::vector<std::string> words(std::size_t route) const;
  // Likewise those of a guest's [[style]].
  std::optional<std::string> style(std::string_view guest) const;

 private:
  SessionFile(std::string path, std::string text)
      : path_(std::move(path)), text_(std::move(text)) {}
  template <class Edit>
  Result<void> change(Edit edit);

  std::string path_;
  std::string text_;
};

}  // namespace dance
