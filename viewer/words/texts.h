// Texts of the windows for dancers, in the language that they read.
//
// Units/frames: UTF-8.
// Ownership:    constants; say() makes a string.
// Threads:      any.
// Failure:      a value too few leaves its `{}`; one too many is left out.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "viewer/words/language.h"
#include "viewer/words/text_table.h"

namespace dance {

#define DANCE_TEXT_NAME(name, ...) name,
enum class Text { DANCE_TEXTS(DANCE_TEXT_NAME) kCount };
#undef DANCE_TEXT_NAME

class Texts {
 public:
  explicit Texts(Language language) : language_(language) {}

  Language language() const { return language_; }
  // Ends with a zero, as Dear ImGui wants it.
  const char* operator[](Text text) const;
  std::string say(Text text, std::initializer_list<std::string_view> values) const;

 private:
  Language language_;
};

}  // namespace dance
