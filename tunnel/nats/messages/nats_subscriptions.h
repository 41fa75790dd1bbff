// Which subjects we listen to at a NATS server, and what has to be said to it about that. Toggling
// a subject says nothing: its end is held for a while, and each waits at most once to be said.
//
// Units/frames: MonoTime of this process's clock; a number is NATS's sid.
// Ownership:    arrays for kMost subjects, allocated at construction; beyond them a new subject is
//               one node of a map.
// Threads:      none inside; one owner.
// Failure:      listen() is false where there are kMost. The number of a subject that ended is used
//               again with another generation: what is still on its way counts as not wanted.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/time.h"

namespace dance {

class NatsSubscriptions {
 public:
  static constexpr std::size_t kMost = 32'768;
  static constexpr Duration kHeld = Duration::s(1);
  struct Line {
    std::string_view subject;  // to begin with, valid until it ends; "": the number ends
    std::uint32_t number = 0;
  };

  NatsSubscriptions();
  NatsSubscriptions(const NatsSubscriptions&) = delete;
  NatsSubscriptions& operator=(const NatsSubscriptions&) = delete;

  bool listen(std::string_view subject);
  void end_listen(std::string_view subject, MonoTime now);
  // Another connection begins, which has been told nothing.
  void begin();
  // What has been held for kHeld is to be said.
  void settle(MonoTime now);
  // The next to be said; each is given once.
  std::optional<Line> take_line();
  bool has_lines() const { return !to_say_.empty(); }

  bool is_wanted(std::uint32_t number) const;
  // To keep the newest of each: count_all() begins, count() for each that came, is_newest() for
  // each again, which says whether at most `kept` are left of its subject.
  void count_all() { ++round_; }
  void count(std::uint32_t number);
  bool is_newest(std::uint32_t number, std::uint32_t kept);

  std::size_t size() const { return by_subject_.size(); }  // with those that are held

 private:
  using Index = std::uint32_t;
  using BySubject = std::map<std::string, Index, std::less<>>;
  struct Entry {
    BySubject::iterator at;  // where is_used
    MonoTime unwanted_since;
    std::uint32_t generation = 1;
    std::uint32_t round = 0;  // of `in_buffer`
    std::uint32_t in_buffer = 0;
    bool is_used = false;
    bool is_wanted = false;
    bool is_said = false;    // the NATS server knows it
    bool is_held = false;    // in held_
    bool is_to_say = false;  // in to_say_
  };

  static constexpr std::uint32_t kGenerations = UINT32_MAX / kMost;
  static std::uint32_t number_of(Index index, const Entry& entry) {
    return entry.generation * static_cast<std::uint32_t>(kMost) + index;
  }
  const Entry* find(std::uint32_t number) const;
  void queue(Index index);
  void release(Index index);

  BySubject by_subject_;
  std::vector<Entry> entries_;
  std::vector<Index> free_, held_, to_say_;
  std::uint32_t round_ = 0;
};

}  // namespace dance
