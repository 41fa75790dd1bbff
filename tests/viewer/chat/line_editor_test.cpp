#include "viewer/chat/line_editor.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "core/bus/chat.h"

namespace dance {
namespace {

class Typed {
 public:
  explicit Typed(std::string_view text) { line.insert(text); }
  Typed& press(int key, bool has_shift = false, bool has_control = false) {
    EXPECT_TRUE(line.on_key({key, false, has_shift, has_control}));
    return *this;
  }
  Typed& type(char32_t character) {
    line.insert(character);
    return *this;
  }
  LineEditor line{kMaxChatCharacters, kMaxChatBytes};
};

TEST(LineEditor, TypesAndErasesLettersOfSeveralBytes) {
  Typed typed("a\xc3\xb1o");
  EXPECT_EQ(typed.line.size(), 3u);
  EXPECT_EQ(typed.press(GLFW_KEY_LEFT).press(GLFW_KEY_BACKSPACE).line.text(), "ao");
  EXPECT_EQ(typed.type(U'\u00fc').line.text(), "a\xc3\xbco");
  EXPECT_EQ(typed.type(U'\U0001f483').line.text(), "a\xc3\xbc\xf0\x9f\x92\x83o");
  EXPECT_EQ(typed.line.before_caret(), "a\xc3\xbc\xf0\x9f\x92\x83");
  EXPECT_EQ(typed.press(GLFW_KEY_HOME).press(GLFW_KEY_DELETE).line.text(),
            "\xc3\xbc\xf0\x9f\x92\x83o");
  EXPECT_EQ(typed.press(GLFW_KEY_END).press(GLFW_KEY_DELETE).type(U'!').line.text(),
            "\xc3\xbc\xf0\x9f\x92\x83o!");
  typed.press(GLFW_KEY_HOME).press(GLFW_KEY_BACKSPACE).press(GLFW_KEY_LEFT);
  EXPECT_EQ(typed.line.size(), 4u);
}

TEST(LineEditor, SelectsAndReplaces) {
  Typed typed("uno dos tres");
  typed.press(GLFW_KEY_LEFT, true, true);
  EXPECT_EQ(typed.line.selection(), "tres");
  EXPECT_EQ(typed.line.before_selection(), "uno dos ");
  EXPECT_EQ(typed.type(U'3').line.text(), "uno dos 3");
  typed.press(GLFW_KEY_HOME).press(GLFW_KEY_RIGHT, true).press(GLFW_KEY_RIGHT, true);
  EXPECT_EQ(typed.line.selection(), "un");
  typed.press(GLFW_KEY_RIGHT);
  EXPECT_EQ(typed.line.selection(), "") << "an arrow leaves the selection at its end";
  EXPECT_EQ(typed.line.before_caret(), "un");
  EXPECT_EQ(typed.press(GLFW_KEY_A, false, true).line.selection(), "uno dos 3");
  EXPECT_EQ(typed.press(GLFW_KEY_BACKSPACE).line.text(), "");
  EXPECT_FALSE(typed.line.on_key({GLFW_KEY_A})) << "a letter is typed as a character";
}

TEST(LineEditor, MovesByWords) {
  Typed typed("hola  a todos");
  typed.press(GLFW_KEY_BACKSPACE, false, true);
  EXPECT_EQ(typed.line.text(), "hola  a ");
  typed.press(GLFW_KEY_HOME).press(GLFW_KEY_RIGHT, false, true);
  EXPECT_EQ(typed.line.before_caret(), "hola  ");
  EXPECT_EQ(typed.press(GLFW_KEY_DELETE, false, true).line.text(), "hola  ");
}

TEST(LineEditor, LeavesOutHiddenCharacters) {
  Typed typed("one\ntwo\r\x1b[2J\xe2\x80\xaethree\xff\xc3");
  EXPECT_EQ(typed.line.text(), "one two[2Jthree");
  EXPECT_TRUE(is_chat_line(typed.line.text()));
  typed.line.clear();
  for (const char32_t bad : {U'\0', U'\n', U'\x7f', U'\u200b', U'\u202e', char32_t{0xd800},
                             char32_t{0x110000}, char32_t{0xffffffff}})
    typed.type(bad);
  EXPECT_TRUE(typed.line.empty());
}

TEST(LineEditor, HoldsNoMoreThanALine) {
  Typed typed(std::string(1000, 'x'));
  EXPECT_EQ(typed.line.size(), kMaxChatCharacters);
  EXPECT_TRUE(is_chat_line(typed.type(U'y').line.text()));
  typed.line.clear();
  for (int i = 0; i < 300; ++i) typed.type(U'\U0001f483');
  EXPECT_EQ(typed.line.size(), kMaxChatBytes / 4) << "by bytes";
  EXPECT_TRUE(is_chat_line(typed.line.text()));
  typed.press(GLFW_KEY_BACKSPACE).type(U'a').type(U'b').type(U'c').type(U'd').type(U'e');
  EXPECT_EQ(typed.line.text().size(), kMaxChatBytes) << "erased bytes are free again";
}

}  // namespace
}  // namespace dance
