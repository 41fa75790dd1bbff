// RoundTrips: how far the servers of known rooms are, and who is in the rooms, asked in a thread of
// its own: names are looked up there, which may take seconds, and answers are taken when they come.
//
// Units/frames: round trips of UDP, the shortest of three.
// Ownership:    owns its thread; the destructor waits for it, a name server's patience at most.
// Threads:      ask() and take() on the drawing thread.
// Failure:      a server that does not answer, or whose name is not known, has no round trip; who
//               is in a room is told with a key for it alone.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <span>
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
  struct Answers {
    std::uint32_t round = 0;
    std::size_t count = 0;
    std::array<Duration, WindowChoices::kMostRooms> round_trips{};
    std::array<bool, WindowChoices::kMostRooms> answered{};
    std::array<RoomGuests, WindowChoices::kMostRooms> guests{};
  };

  // `has_answers` is called in the thread when there are some.
  explicit RoundTrips(std::function<void()> has_answers);
  ~RoundTrips();
  RoundTrips(const RoundTrips&) = delete;
  RoundTrips& operator=(const RoundTrips&) = delete;

  // Forgets what was asked before.
  void ask(Question question);
  // Answers to what was asked last, when they are there; once.
  const Answers* take();

 private:
  void answer(const Question& question, std::uint32_t round);
  void measure(std::span<const Address> servers, Answers& answers) const;
  void ask_guests(const Question& question, std::span<const Address> servers,
                  Answers& answers) const;
  void finish();

  std::function<void()> has_answers_;
  std::thread thread_;
  std::atomic<bool> is_busy_{false};
  std::atomic<bool> is_ended_{false};
  Question next_;  // asked while the thread is busy
  bool has_next_ = false;
  std::uint32_t round_ = 0;
  Latest<Answers> answers_;
};

}  // namespace dance
