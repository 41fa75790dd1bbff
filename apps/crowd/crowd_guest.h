// One simulated guest of a crowd: a link without a bus, with all that links do (hello, encryption,
// states, codec, acknowledgements, feedback, pings), a dance, and a count of what she hears of the
// other guests of her room.
//
// What is counted: of each other guest, from when the roster told of her, every pose by its
// sequence. What was not heard a second after it was sent is missed, also when it comes later.
//
// Units/frames: MonoTime of this process.
// Ownership:    owns its link and dancer; what it is made with must outlive it.
// Threads:      its worker's.
// Failure:      join() tells when there is no socket to be had; what the server says against a
//               guest is told in trouble().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/crowd/crowd_board.h"
#include "apps/crowd/crowd_dances.h"
#include "apps/crowd/crowd_plan.h"
#include "apps/crowd/crowd_tally.h"
#include "tunnel/link/link.h"

namespace dance {

// A server and a room on it, as links ask for them.
struct CrowdDoor {
  std::string server;  // as the user names it
  std::vector<Address> addresses;
  LinkKey key;
};

constexpr std::size_t kNearGuests = 4;

class CrowdGuest {
 public:
  struct Setting {
    const CrowdPlan& plan;
    CrowdBoard& board;
    const CrowdDoor& door;
  };

  CrowdGuest(std::size_t number, const Setting& setting, std::unique_ptr<Dancer> dancer,
             const CrowdDances::Place& place, CrowdTally& tally);
  CrowdGuest(const CrowdGuest&) = delete;
  CrowdGuest& operator=(const CrowdGuest&) = delete;

  Result<void> join(Poller& poller);
  void leave();
  bool has_joined() const { return link_ != nullptr; }
  bool is_present() const { return link_ && link_->is_connected(); }
  // Sends the pose of now.
  void dance(MonoTime now);
  // `before`: the newest sequence of each guest a second ago. Brings counts of the link into the
  // tally.
  void settle(const std::vector<std::uint32_t>& before, MonoTime now);
  // Why she is not in, as one line; "" where nothing was said.
  const std::string& trouble() const { return trouble_; }

 private:
  // What she has heard of another.
  struct Heard {
    bool is_here = false;
    bool is_near = false;    // of the kNearGuests who stand nearest
    std::uint32_t last = 0;  // sequence
  };

  LinkOptions options() const;
  LinkHandlers handlers();
  void on_pose(const GuestId& from, const Pose& pose);
  void on_joined(const GuestId& guest);
  void bring_counts(MonoTime now);
  void find_near();
  void miss(const Heard& heard, std::int32_t poses);
  Heard* heard_of(const GuestId& guest, std::size_t& number);

  std::size_t number_;
  Setting setting_;
  std::unique_ptr<Dancer> dancer_;
  CrowdDances::Place place_;
  CrowdTally& tally_;
  GuestId name_;
  Duration phase_;
  MonoTime made_;
  std::uint32_t sequence_ = 0;
  Pose pose_;
  std::vector<Heard> heard_;  // by place in the room
  std::string trouble_;
  LinkCounters counted_;  // of this link, as far as the tally has them
  std::int64_t counted_lost_ = 0;
  std::unique_ptr<Link> link_;  // last, as its handlers use the rest
};

}  // namespace dance
