// How a host's link asks the server to remove a guest from the room, what the server answers, and
// what it lets a link do. Built and parsed; docs/wire-format.md says it byte by byte. A peer that
// does not know these types drops them, as it drops any that it does not know.
//
// Units/frames: none.
// Ownership:    plain values; nothing here allocates.
// Threads:      none inside.
// Failure:      as in tunnel/wire/wire.h.
#pragma once

#include "core/base/time.h"
#include "tunnel/wire/wire.h"

namespace dance::wire {

// Of each of the three, behind its type: another form is another meaning, and not parsed.
constexpr std::uint8_t kRemovalForm = 1;
// A guest who was removed is refused for so long, and does not ask.
constexpr Duration kRemovedFor = Duration::s(600);
constexpr std::uint16_t kMostRemoved_s = 3600;
// A link asks until it is answered, with each ping, so often.
constexpr int kMostRemovalAsks = 10;

// From a link whose key is a host's.
struct RemovalRequest {
  std::uint32_t number = 0;  // not 0; the same number again is the same request
  GuestId guest;
};

enum class RemovalResult : std::uint8_t {
  kDone = 1,
  kNotAllowed = 2,
  kNoSuchGuest = 3,
  kPassedOn = 4,  // the guest came through another server of the cluster, which is told
  kTooMany = 5,   // at once
};
struct RemovalAnswer {
  std::uint32_t number = 0;  // of the request
  RemovalResult result = RemovalResult::kDone;
};

// What the link's key lets it do, told to those that may.
struct Rights {
  bool may_remove = false;
};

// Whole datagrams, opening included.
std::size_t build(const RemovalRequest& request, std::span<std::uint8_t> out);
std::size_t build(const RemovalAnswer& answer, std::span<std::uint8_t> out);
std::size_t build(const Rights& rights, std::span<std::uint8_t> out);
std::optional<RemovalRequest> parse_removal_request(Bytes body);
std::optional<RemovalAnswer> parse_removal_answer(Bytes body);
std::optional<Rights> parse_rights(Bytes body);

}  // namespace dance::wire
