#include "viewer/words/shown_name.h"

#include <algorithm>
#include <string>

#include "core/base/text/guest_id_hint.h"
#include "viewer/words/letters.h"

namespace dance {
namespace {

// The name without letters that would be drawn as question marks.
ShownName drawn_name(const ShownName& name) {
  std::string drawn;
  for (std::string_view left = name.view(); !left.empty();) {
    const auto character = first_character(left);
    if (!character) break;
    if (is_drawn_letter(character->code)) drawn += left.substr(0, character->bytes);
    left.remove_prefix(character->bytes);
  }
  return parse_shown_name(drawn).value_or(ShownName());
}

// Names look alike if they differ in capitals, accents and signs alone.
bool look_alike(std::string_view a, std::string_view b) {
  if (a == b) return true;
  const std::string id = suggested_guest_id(a);
  return !id.empty() && id == suggested_guest_id(b);
}

}  // namespace

ShownNames::ShownNames(std::span<const Named> named, std::span<const GuestId> others) {
  entries_.reserve(named.size());
  std::vector<Named> drawn;
  for (const Named& one : named) drawn.push_back({one.guest, drawn_name(one.name)});
  // A guest without a name is shown by the id.
  const auto seen_as = [](const Named& one) {
    return one.name.empty() ? one.guest.view() : one.name.view();
  };
  for (const Named& one : drawn) {
    if (one.name.empty()) continue;
    // "Ana (ana)" as a chosen name would look like Ana with her id.
    const bool is_alike =
        one.name.view().find('(') != std::string_view::npos ||
        std::any_of(drawn.begin(), drawn.end(),
                    [&](const Named& other) {
                      return other.guest != one.guest && look_alike(seen_as(other), seen_as(one));
                    }) ||
        std::any_of(others.begin(), others.end(), [&](const GuestId& other) {
          return other != one.guest && look_alike(other.view(), seen_as(one));
        });
    std::string text(one.name.view());
    if (is_alike) text += " (" + std::string(one.guest.view()) + ")";
    Entry entry{one.guest, {}};
    if (entry.text.assign(text)) entries_.push_back(entry);
  }
}

std::string_view ShownNames::find(const GuestId& guest) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.guest == guest; });
  return found == entries_.end() ? std::string_view() : found->text.view();
}

std::string_view shown_name(const ShownNames& names, const GuestId& guest, const Texts& texts) {
  if (const std::string_view name = names.find(guest); !name.empty()) return name;
  const std::string_view id = guest.view();
  if (id == "dancer") return texts[Text::kNameDancer];
  if (id == "partner") return texts[Text::kNamePartner];
  if (id == "teacher") return texts[Text::kNameTeacher];
  return id;
}

}  // namespace dance
