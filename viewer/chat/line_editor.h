// LineEditor: edits one line of text, with a caret and a selection.
//
// Units/frames: places count characters from the beginning.
// Failure:      hidden characters, and those beyond the line's size, are left out.
#pragma once

#include <string>
#include <string_view>

#include "viewer/panel/window_panel.h"

namespace dance {

class LineEditor {
 public:
  LineEditor(std::size_t most_characters, std::size_t most_bytes)
      : most_characters_(most_characters), most_bytes_(most_bytes) {}

  // A character that was typed, or text that is pasted; either replaces the selection.
  void insert(char32_t character);
  void insert(std::string_view utf8);
  // Arrows, Home, End, Backspace, Delete, and Ctrl+A; with Ctrl by words, with Shift selecting.
  // True if the key was one of these.
  bool on_key(const KeyPress& press);
  void erase_selection();
  void clear();

  std::string text() const { return utf8_of(0, line_.size()); }
  std::string before_caret() const { return utf8_of(0, caret_); }
  std::string before_selection() const { return utf8_of(0, first()); }
  std::string selection() const { return utf8_of(first(), last()); }
  std::size_t size() const { return line_.size(); }
  bool empty() const { return line_.empty(); }

 private:
  std::size_t first() const { return caret_ < anchor_ ? caret_ : anchor_; }
  std::size_t last() const { return caret_ < anchor_ ? anchor_ : caret_; }
  std::size_t word_before() const;
  std::size_t word_after() const;
  void go(std::size_t place, bool selects);
  void erase_to(std::size_t place);
  std::string utf8_of(std::size_t begin, std::size_t end) const;

  std::size_t most_characters_, most_bytes_;
  std::u32string line_;
  std::size_t bytes_ = 0;  // the line's size in UTF-8
  std::size_t caret_ = 0;
  std::size_t anchor_ = 0;  // the other end of the selection
};

}  // namespace dance
