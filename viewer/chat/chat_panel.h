// ChatPanel: the chat of the room, at the bottom left. The newest lines are shown for some seconds.
// Enter opens a field to write in, with the last lines above it. Applause and hearts have a key
// each, and are drawn above the dancers' heads (viewer/overlay/dance_sign.h).
//
// Units/frames: pixels from the top left; times of the house's clock.
// Ownership:    borrows what ChatNeeds names, which must outlive it.
// Threads:      the drawing thread.
// Failure:      without a guest of this house nothing can be sent; the field shows that.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/bus/chat.h"
#include "viewer/chat/line_editor.h"
#include "viewer/panel/window_panel.h"

struct ImDrawList;

namespace dance {

struct ChatNeeds {
  // The guest of this house in whose name lines are sent; nullopt while there is none.
  std::function<std::optional<GuestId>()> writer;
  // Sends a line or a sign of that guest; calls for each of the two are at least kChatPeriod apart.
  // Not set for a recording, which has no field to write in.
  std::function<void(const GuestId& guest, ChatKind kind, std::string_view text)> send;
  // True if this guest's lines are not shown in this window.
  std::function<bool(const GuestId& guest)> is_hidden;
  // The height at the bottom that other panels cover.
  std::function<float(const PanelFrame& frame)> bottom_px;
  Language language = Language::kEnglish;
};

class ChatPanel final : public WindowPanel {
 public:
  static constexpr std::size_t kMostFresh = 4;  // lines shown while the field is closed
  static constexpr Duration kFresh = Duration::s(10);

  explicit ChatPanel(ChatNeeds needs) : needs_(std::move(needs)), texts_(needs_.language) {}

  Text title() const override;
  std::span<const KeyHelp> keys() const override;
  bool is_open() const override { return is_open_; }
  bool on_key(const KeyPress& press) override;
  bool on_character(char32_t character) override;
  void draw(const PanelFrame& frame) override;

 private:
  bool on_field_key(const KeyPress& press);
  void send_line();
  bool send_sign(ChatKind kind);
  // Returns the upper edge of the field.
  float draw_field(const PanelFrame& frame, float bottom_px);
  void draw_text(ImDrawList& list, const PanelFrame& frame, float x, float y, float width) const;
  void draw_lines(const PanelFrame& frame, float bottom_px) const;

  ChatNeeds needs_;
  Texts texts_;
  LineEditor editor_{kMaxChatCharacters, kMaxChatBytes};
  bool is_open_ = false;
  bool sends_ = false;  // Enter was pressed; the line is sent kChatPeriod after the last one
  MonoTime now_;        // the time of the last picture
  MonoTime line_sent_, sign_sent_;
};

}  // namespace dance
