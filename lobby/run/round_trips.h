// RoundTrips: how far the servers of known rooms are, and who is in the rooms, asked in a thread of
// its own: names are looked up there, which may take seconds, and what is known of a server is
// there to be taken before the next one has answered.
//
// Units/frames: round trips of UDP, the shortest of three.
// Ownership:    owns its thread; the destructor waits for it, a name server's timeout at most.
// Threads:      ask(), take() and is_busy() on the drawing thread.
// Failure:      a server that does not answer, or whose name is not known, has no round trip; who
//               is in a room is told with a key for it alone.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/latest.h"
#include "core/base/time.h"
#include "house/session_window.h"
#include "tunnel/link/room_question.h"

namespace dance {

class RoundTrips {
 public:
  struct Question {
    std::vector<KnownRoom> rooms;
    GuestId guest;         // who would come in
    std::string settings;  // the session file, which may name keys of its own
  };
  struct Answer {
    KnownRoom room;
    enum class Server : std::uint8_t { kAsking, kSilent, kAnswers };
    Server server = Server::kAsking;
    Duration round_trip;
    RoomGuests guests;
    MonoTime told;  // when the server said who is there, or did not
  };
  // In the order of the question; each time with what was known before.
  struct Answers {
    std::uint32_t round = 0;
    std::vector<Answer> rooms;
  };

  // `has_answers` is called in the thread when there are some.
  explicit RoundTrips(std::function<void()> has_answers);
  ~RoundTrips();
  RoundTrips(const RoundTrips&) = delete;
  RoundTrips& operator=(const RoundTrips&) = delete;

  // Forgets what was asked before, and asks no further for that.
  void ask(Question question);
  // Answers to what was asked last, where there are new ones.
  const Answers* take();
  // More answers are to come. When it is not, take() has the last ones.
  bool is_busy() const { return has_next_ || is_asking_.load(std::memory_order_acquire); }

 private:
  void start(Question question);
  void finish();

  std::function<void()> has_answers_;
  std::thread thread_;
  std::atomic<bool> is_asking_{false};
  std::atomic<bool> stops_{false};  // what the thread asks for is not wanted any more
  std::atomic<bool> is_ended_{false};
  Question next_;  // asked while the thread is busy
  bool has_next_ = false;
  std::uint32_t round_ = 0;
  Latest<Answers> answers_;
};

}  // namespace dance
