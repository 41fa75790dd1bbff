#include "viewer/chat/line_editor.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>

#include "core/base/text/plain_text.h"

namespace dance {
namespace {

std::size_t bytes_of(char32_t code) {
  return code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
}

void append(std::string& text, char32_t code) {
  const std::size_t bytes = bytes_of(code);
  constexpr unsigned kLead[] = {0, 0, 0xc0, 0xe0, 0xf0};
  const auto put = [&](unsigned byte) { text += static_cast<char>(byte); };
  if (bytes == 1) return put(code);
  put(kLead[bytes] | static_cast<unsigned>(code >> (6 * (bytes - 1))));
  for (std::size_t i = bytes - 1; i-- > 0;) put(0x80u | ((code >> (6 * i)) & 0x3fu));
}

bool may_stand(char32_t code) {
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code <= 0x10ffff && !is_surrogate && !is_hidden_character(code);
}

}  // namespace

void LineEditor::insert(char32_t character) {
  if (!may_stand(character)) return;
  erase_selection();
  if (line_.size() >= most_characters_ || bytes_ + bytes_of(character) > most_bytes_) return;
  line_.insert(caret_, 1, character);
  bytes_ += bytes_of(character);
  go(caret_ + 1, false);
}

// A line break becomes a space.
void LineEditor::insert(std::string_view utf8) {
  erase_selection();
  for (std::size_t i = 0; i < most_characters_ && !utf8.empty(); ++i) {
    const auto character = first_character(utf8);
    if (character) insert(character->code == '\n' ? U' ' : static_cast<char32_t>(character->code));
    utf8.remove_prefix(character ? character->bytes : 1);
  }
}

void LineEditor::erase_selection() {
  for (std::size_t i = first(); i < last(); ++i) bytes_ -= bytes_of(line_[i]);
  line_.erase(first(), last() - first());
  go(first(), false);
}

void LineEditor::clear() {
  line_.clear();
  bytes_ = caret_ = anchor_ = 0;
}

std::size_t LineEditor::word_before() const {
  std::size_t place = caret_;
  while (place > 0 && line_[place - 1] == U' ') --place;
  while (place > 0 && line_[place - 1] != U' ') --place;
  return place;
}

std::size_t LineEditor::word_after() const {
  std::size_t place = caret_;
  while (place < line_.size() && line_[place] != U' ') ++place;
  while (place < line_.size() && line_[place] == U' ') ++place;
  return place;
}

void LineEditor::go(std::size_t place, bool selects) {
  caret_ = place;
  if (!selects) anchor_ = place;
}

void LineEditor::erase_to(std::size_t place) {
  if (first() == last()) go(place, true);
  erase_selection();
}

bool LineEditor::on_key(const KeyPress& press) {
  const std::size_t before = caret_ > 0 ? caret_ - 1 : 0;
  const std::size_t after = caret_ < line_.size() ? caret_ + 1 : caret_;
  const bool selects = press.has_shift, by_words = press.has_control;
  const bool leaves_selection = first() != last() && !selects && !by_words;
  switch (press.key) {
    case GLFW_KEY_LEFT:
      go(leaves_selection ? first() : by_words ? word_before() : before, selects);
      return true;
    case GLFW_KEY_RIGHT:
      go(leaves_selection ? last() : by_words ? word_after() : after, selects);
      return true;
    case GLFW_KEY_HOME:
      go(0, selects);
      return true;
    case GLFW_KEY_END:
      go(line_.size(), selects);
      return true;
    case GLFW_KEY_BACKSPACE:
      erase_to(by_words ? word_before() : before);
      return true;
    case GLFW_KEY_DELETE:
      erase_to(by_words ? word_after() : after);
      return true;
    case GLFW_KEY_A:
      if (!press.has_control) return false;
      anchor_ = 0;
      caret_ = line_.size();
      return true;
    default:
      return false;
  }
}

std::string LineEditor::utf8_of(std::size_t begin, std::size_t end) const {
  std::string text;
  for (std::size_t i = begin; i < end; ++i) append(text, line_[i]);
  return text;
}

}  // namespace dance
