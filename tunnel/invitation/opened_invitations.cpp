#include "tunnel/invitation/opened_invitations.h"

#include <algorithm>

#include "core/base/take_line.h"

namespace dance {
namespace {

constexpr std::string_view kPendingWord = "pending";
constexpr std::string_view kDoneWord = "opened";
constexpr std::size_t kMostTitle = 400;

bool is_fingerprint(std::string_view text) {
  return text.size() == PrivateKey::kFingerprintLength &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

// A title is what a key's line has before the key.
std::string any_line_of(std::string_view title) {
  return "dance-key:" + std::string(title) + "#A" + std::string(PublicKey::kTextLength - 1, 'g');
}

}  // namespace

Result<OpenedInvitations> OpenedInvitations::parse(std::string_view text, const std::string& name) {
  OpenedInvitations made;
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    std::string_view line = take_line(text);
    if (line.empty() || line.front() == '#') continue;
    const auto take_part = [&line] {
      const std::string_view part = line.substr(0, line.find(' '));
      line.remove_prefix(std::min(line.size(), part.size() + 1));
      return part;
    };
    Row row;
    row.invitation = take_part();
    const std::string_view word = take_part();
    const auto bad = [&] {
      return fail(name + " line " + std::to_string(number) +
                  ": no opened invitation; remove the line, and ask for another invitation if this "
                  "house is not let in");
    };
    if (!is_fingerprint(row.invitation) || line.empty() || line.size() > kMostTitle) return bad();
    row.is_pending = word == kPendingWord;
    const auto titled = HouseKey::parse(any_line_of(line));
    if ((!row.is_pending && word != kDoneWord) || !titled || titled->title() != line) return bad();
    row.title = line;
    made.put(std::move(row));
  }
  return made;
}

std::string OpenedInvitations::text() const {
  std::string text = "# Invitations that were opened here.\n";
  for (const Row& row : rows_)
    text += row.invitation + " " + std::string(row.is_pending ? kPendingWord : kDoneWord) + " " +
            row.title + "\n";
  return text;
}

const OpenedInvitations::Row* OpenedInvitations::find(std::string_view invitation) const {
  const auto found = std::find_if(rows_.begin(), rows_.end(),
                                  [&](const Row& row) { return row.invitation == invitation; });
  return found == rows_.end() ? nullptr : &*found;
}

bool OpenedInvitations::is_pending(std::string_view invitation) const {
  const Row* row = find(invitation);
  return row != nullptr && row->is_pending;
}

bool OpenedInvitations::is_done(std::string_view invitation) const {
  const Row* row = find(invitation);
  return row != nullptr && !row->is_pending;
}

void OpenedInvitations::put(Row row) {
  forget(row.invitation);
  if (rows_.size() == kMost) rows_.erase(rows_.begin());
  rows_.push_back(std::move(row));
}

void OpenedInvitations::begin(const std::string& invitation, const HouseKey& key) {
  put({invitation, key.title(), true});
}

void OpenedInvitations::end(const std::string& invitation, const HouseKey& key) {
  put({invitation, key.title(), false});
}

void OpenedInvitations::forget(std::string_view invitation) {
  std::erase_if(rows_, [&](const Row& row) { return row.invitation == invitation; });
}

}  // namespace dance
