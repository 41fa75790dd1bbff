// ShownNames: the text that names each guest of a picture: the shown name, else the id. If a name
// looks like another guest's name or id, the guest's id follows it, so that guests cannot pass for
// one another.
//
// Failure:   letters that the windows' fonts lack are left out; if none is left the id is shown.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/text/shown_name.h"
#include "viewer/words/texts.h"

namespace dance {

class ShownNames {
 public:
  struct Named {
    GuestId guest;
    ShownName name;
  };

  ShownNames() = default;
  // `others`: all guests of the picture, whose ids no other guest's name may look like.
  ShownNames(std::span<const Named> named, std::span<const GuestId> others);
  // "" if the guest has no name; a zero follows the text.
  std::string_view find(const GuestId& guest) const;

 private:
  // "Ana López (ana-2)".
  using Shown = FixedString<kMaxShownNameBytes + kMaxGuestIdLength + 3>;
  struct Entry {
    GuestId guest;
    Shown text;
  };
  std::vector<Entry> entries_;
};

// The text for a guest in a window. Ids that the programs chose themselves are shown in the
// reader's language. A zero follows the text, as Dear ImGui requires.
std::string_view shown_name(const ShownNames& names, const GuestId& guest, const Texts& texts);

}  // namespace dance
