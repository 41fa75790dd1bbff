#include "tunnel/link/signals/link_removals.h"

#include <algorithm>
#include <array>

namespace dance {

void LinkRemovals::ask(const GuestId& guest, std::int32_t number) {
  const bool is_known =
      settled_.contains(number) || std::any_of(wishes_.begin(), wishes_.end(),
                                               [&](const Wish& it) { return it.number == number; });
  if (is_known) return;
  if (link_.locals.find(guest) != nullptr) return tell(number, RemovalVerdict::kOwnGuest);
  if (!wishes_.try_push({guest, number})) return tell(number, RemovalVerdict::kTooMany);
  if (link_.handlers.on_removal) link_.handlers.on_removal(number, RemovalVerdict::kAsked);
  if (link_.is_connected()) send(wishes_[wishes_.size() - 1]);
}

void LinkRemovals::repeat() {
  for (std::size_t i = wishes_.size(); i-- > 0;) {
    if (wishes_[i].asked < wire::kMostRemovalAsks) {
      send(wishes_[i]);
      continue;
    }
    const std::int32_t number = wishes_[i].number;
    wishes_.erase_at(i);
    tell(number, RemovalVerdict::kNoAnswer);
  }
}

void LinkRemovals::send(Wish& wish) {
  ++wish.asked;
  std::array<std::uint8_t, 64> out;
  const wire::RemovalRequest request{static_cast<std::uint32_t>(wish.number), wish.guest};
  link_.send({out.data(), wire::build(request, out)});
}

void LinkRemovals::tell(std::int32_t number, RemovalVerdict verdict) {
  if (settled_.is_full()) settled_.erase_at(0);
  [[maybe_unused]] const bool pushed = settled_.try_push(number);
  if (link_.handlers.on_removal) link_.handlers.on_removal(number, verdict);
}

bool LinkRemovals::on_answer(wire::Bytes body) {
  const auto answer = wire::parse_removal_answer(body);
  if (!answer) return false;
  for (std::size_t i = 0; i < wishes_.size(); ++i) {
    if (static_cast<std::uint32_t>(wishes_[i].number) != answer->number) continue;
    const std::int32_t number = wishes_[i].number;
    wishes_.erase_at(i);
    tell(number, static_cast<RemovalVerdict>(answer->result));
    break;
  }
  return true;
}

static_assert(static_cast<int>(wire::RemovalResult::kDone) ==
                  static_cast<int>(RemovalVerdict::kDone) &&
              static_cast<int>(wire::RemovalResult::kTooMany) ==
                  static_cast<int>(RemovalVerdict::kTooMany));

bool LinkRemovals::on_rights(wire::Bytes body) {
  const auto rights = wire::parse_rights(body);
  if (!rights) return false;
  link_.may_remove = rights->may_remove;
  return true;
}

}  // namespace dance
