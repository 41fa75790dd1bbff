// LobbyKit: the parts that the window's screens are made of: cards, buttons, choices, rows, fields,
// in one look. Large enough for a finger, and reached by keys as well as by the mouse.
//
// Units/frames: `u` are pixels of a monitor with 96 dpi; the kit multiplies them by its scale.
// Ownership:    refers to fonts of Dear ImGui and to the list for clipped texts.
// Threads:      the drawing thread, within a frame of Dear ImGui.
// Failure:      a text that does not fit into its place is noted in `clipped`, for tests.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

struct ImFont;

namespace dance {

struct LobbyFonts {
  ImFont* body = nullptr;
  ImFont* title = nullptr;
  ImFont* small = nullptr;
};

// Sizes of the fonts, before scaling.
constexpr float kLobbyBody_u = 18.0f, kLobbyTitle_u = 28.0f, kLobbySmall_u = 15.0f;

enum class ButtonLook { kPlain, kAccent, kChosen, kQuiet };

class LobbyKit {
 public:
  LobbyKit(const LobbyFonts& fonts, float scale, std::vector<std::string>* clipped)
      : fonts_(fonts), scale_(scale), clipped_(clipped) {}

  float px(float u) const { return u * scale_; }
  // Colours, distances and the like, of the current context of Dear ImGui.
  void apply_style() const;

  void title(const char* text);
  void text(const std::string& text);  // wrapped
  void note(const std::string& text);  // smaller and dimmer, wrapped
  // A word before what it is about, in a column of its own.
  void label(const char* text);
  void gap(float u);

  void begin_card(const char* title);
  void end_card();

  // As wide as its words; 0 = that, else at least so many u.
  bool button(const char* words, ButtonLook look = ButtonLook::kPlain, float least_u = 0.0f);
  bool small_button(const char* words);  // for what few want
  // One of several beside each other.
  bool choice(const char* words, bool is_chosen);
  // In the same line where it fits, else in the next.
  void beside(const char* next_words, float least_u = 0.0f);
  // A line of a list: what it is, more of it, and at the right how it stands. True when chosen.
  bool row(const char* id, const std::string& what, const std::string& more, bool is_chosen,
           float right_room_u = 0.0f);
  // A tile to click on: a heading and what it does.
  bool tile(const char* heading, const char* what, float width_px, ButtonLook look);
  // One line to type in; true when it has changed.
  bool field(const char* id, std::string& value, float width_u, std::size_t most_bytes);
  // Text to copy, in a box.
  void box(const std::string& text);
  // An OpenGL texture with rounded corners, rows from the bottom; null = an empty box.
  void picture(void* texture, float width_px, float height_px);
  // A clickable picture with a caption.
  bool picture_choice(const char* id, void* texture, const std::string& words, float width_u,
                      float height_u, bool is_chosen);
  // A clickable colour (sRGB, 0xRRGGBB).
  bool swatch(const char* id, std::uint32_t rgb, bool is_chosen);
  // A picture at the right edge, behind the items that follow. It fades out to the left and at the
  // bottom; if it is too wide, both sides are cut off.
  void backdrop(void* texture, float aspect, float width_px, float height_px);
  // How loud it is, and was: 0 to 1.
  void meter(float level, float held);
  // A QR code of so many modules in a row, with the quiet zone that a phone wants.
  void code(int size, const std::vector<bool>& dark);
  // A strip over the whole width with words, and buttons at its end; nullptr = no button.
  enum class Strip { kNone, kButton, kOtherButton, kClose };
  Strip strip(int id, bool is_trouble, const std::string& words, const std::string& detail,
              const char* button, const char* other_button);

  float room_px() const;  // from here to the right edge of the card
  const LobbyFonts& fonts() const { return fonts_; }
  // Makes the text plain, because names of files and devices come from outside, and shortens it to
  // that width in the current font, with an ellipsis in the middle.
  static std::string shortened(const std::string& full_text, float width_px);

 private:
  void look_at_item(const char* words);
  void look_at_text(const char* words, float width_px, float room_px);

  LobbyFonts fonts_;
  float scale_;
  std::vector<std::string>* clipped_;
};

}  // namespace dance
