// The server's record of who joined, who was refused and who was removed. It is bounded, and no
// peer can push the entries of others out of it:
// - joins, refusals and removals have separate lists;
// - refusals of one network for one cause are one entry with a count;
// - a full list drops the oldest entry of the key that has most entries, of refusals the oldest of
//   the wide network (IPv4 /16, IPv6 /48) that has most.
// Text from strangers is escaped before it is stored.
//
// Units:   seconds of UTC.
// Failure: parse_audit_line() returns nullopt for a line that AuditLog does not write.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/net/address.h"
#include "tunnel/server/core/audit_event.h"

namespace dance {

struct AuditEntry {
  AuditKind kind = AuditKind::kJoined;
  std::int64_t first_s = 0;
  std::int64_t last_s = 0;
  std::uint64_t count = 1;
  std::string key;      // printable; "" where the peer gave no name
  std::string address;  // the newest, with its port
  std::string network;  // of the address: IPv4 address, or IPv6 /64
  std::string wide_network;
  std::string room;
  std::string guests;  // "alice alice-2"
  std::string cause;
  std::string by;
  bool operator==(const AuditEntry&) const = default;
};

// One JSON object on one line, without its end of line.
std::string audit_line(const AuditEntry& entry);
std::optional<AuditEntry> parse_audit_line(std::string_view line);

class AuditLog {
 public:
  using Lines = std::vector<std::shared_ptr<const std::string>>;
  // Entries of each kind, in the order of AuditKind.
  static constexpr std::array<std::size_t, 3> kMostEntries{1024, 256, 256};
  // A repeated join of the same guests from the same network within this time is counted, not
  // listed again.
  static constexpr std::int64_t kSameJoinWithin_s = 600;
  static constexpr std::size_t kLongestKey = 48;

  void add(const Address& from, const AuditEvent& event, std::int64_t now_s);
  // An entry of an earlier run of the server.
  void restore(const AuditEntry& entry) { keep(entry); }
  // Shares the lines: cheap, so that another thread can write them. Sorted by kind, then by time.
  Lines lines() const;
  // Counts changes, so that a reader knows whether there is something new.
  std::uint64_t changes() const { return changes_; }

 private:
  struct Kept {
    AuditEntry entry;
    std::size_t identity = 0;  // equal for events that are counted as one entry
    std::size_t group = 0;     // whose entry it is, for fairness
    std::size_t subgroup = 0;
    std::shared_ptr<const std::string> line;
  };
  void keep(AuditEntry entry);
  static void make_place(std::vector<Kept>& list);

  std::array<std::vector<Kept>, 3> lists_;  // by kind; the newest last
  std::uint64_t changes_ = 0;
};

}  // namespace dance
