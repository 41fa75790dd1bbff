#include "viewer/window/printed_keys.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>

#include <array>

namespace dance {
namespace {

struct Sign {
  unsigned int letter;
  int key;
};
constexpr std::array<Sign, 5> kSigns{{
    {'?', GLFW_KEY_F1},
    {'[', GLFW_KEY_LEFT_BRACKET},
    {']', GLFW_KEY_RIGHT_BRACKET},
    {',', GLFW_KEY_COMMA},
    {'.', GLFW_KEY_PERIOD},
}};

bool is_sign(int key) {
  for (const Sign& sign : kSigns)
    if (key == static_cast<int>(sign.letter)) return true;  // GLFW numbers signs as ASCII does
  return false;
}

// Greek, Cyrillic, Hebrew…: keyboards of these bear Latin signs too, at their American places, and
// some can print no bracket.
bool is_of_other_script(const char* printed) {
  constexpr unsigned char kFirst = 0xcd;  // of U+0340 to U+037F; Latin letters are before
  return printed != nullptr && static_cast<unsigned char>(printed[0]) >= kFirst;
}

// The key that bears this letter or sign.
int printed_key(const RawKey& raw) {
  if (raw.key >= GLFW_KEY_0 && raw.key <= GLFW_KEY_9) return raw.key;
  const char* name = raw.printed;
  if (name == nullptr || name[0] <= ' ' || name[0] > '~' || name[1] != '\0') return raw.key;
  return name[0] >= 'a' && name[0] <= 'z' ? name[0] - 'a' + GLFW_KEY_A : name[0];
}

}  // namespace

std::optional<KeyPress> press_of_key(const RawKey& raw) {
  if (raw.has_alt_gr || (raw.modifiers & GLFW_MOD_ALT) != 0) return std::nullopt;
  const int key = printed_key(raw);
  if (is_sign(key) && !is_of_other_script(raw.printed)) return std::nullopt;
  return KeyPress{key, raw.is_repeat, (raw.modifiers & GLFW_MOD_SHIFT) != 0,
                  (raw.modifiers & GLFW_MOD_CONTROL) != 0};
}

std::optional<KeyPress> press_of_letter(unsigned int letter, bool is_repeat) {
  for (const Sign& sign : kSigns)
    if (letter == sign.letter) return KeyPress{sign.key, is_repeat};
  return std::nullopt;
}

}  // namespace dance
