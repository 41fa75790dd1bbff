// ChatBoard: the newest lines that guests wrote, from the bus thread to the drawing thread.
//
// Units/frames: times of the house's clock.
// Ownership:    kMostLines lines; never allocates after construction.
// Threads:      on_line(), clear() and carry() on the bus thread; take() on the drawing thread.
// Failure:      when the board is full, the oldest line is dropped.
#pragma once

#include <algorithm>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/latest.h"
#include "core/bus/chat.h"

namespace dance {

struct ChatLine {
  GuestId guest;
  ChatText text;
  MonoTime written;
};

class ChatBoard {
 public:
  static constexpr std::size_t kMostLines = 20;
  using Lines = FixedList<ChatLine, kMostLines>;

  // Lines of several guests may arrive out of order, so they are sorted.
  void on_line(const ChatLine& line) {
    if (lines_.is_full()) lines_.erase_at(0);
    const bool pushed = lines_.try_push(line);
    DANCE_ASSERT(pushed);
    std::stable_sort(lines_.begin(), lines_.end(),
                     [](const ChatLine& a, const ChatLine& b) { return a.written < b.written; });
    latest_.put(lines_);
  }
  void clear() {
    lines_.clear();
    latest_.put(lines_);
  }
  // Saves or restores all lines, as GuestBoard::carry() does. Restore into an empty board.
  template <class Archive>
  void carry(Archive& archive) {
    auto count = static_cast<std::uint32_t>(lines_.size());
    archive(count);
    if (count > kMostLines) return archive.refuse();
    while (lines_.size() < count)
      if (!lines_.try_push({})) return;
    for (ChatLine& line : lines_) {
      archive(line.guest), archive(line.text), archive(line.written);
      if (!line.guest.is_set() || !is_chat_line(line.text.view())) archive.refuse();
    }
    latest_.put(lines_);
  }
  // The lines if they have changed since the last call, else nullptr. Valid until the next call.
  const Lines* take() { return latest_.take(); }

 private:
  Lines lines_;  // used by the bus thread only
  Latest<Lines> latest_;
};

}  // namespace dance
