// LineLane: two dancers over one emulated line, for `dance bench line`. The lead's house is at the
// server; the follow's is behind the line, so that each pose crosses it once. Server, links and
// line are the real ones, on loopback sockets of their own.
//
// Units/frames: up is from the follow to the lead. Times are this process's clock.
// Ownership:    owns its server, line and links; poller and poses must outlive it.
// Threads:      the poller's.
// Failure:      open() tells what could not be had.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/line/line_meter.h"
#include "core/net/poller.h"
#include "testing/line/lossy_proxy.h"
#include "tunnel/link/link.h"
#include "tunnel/server/server.h"

namespace dance {

// What both dance; by heart, over and over.
struct LineDance {
  Duration frame;
  std::vector<Pose> lead, follow;
};

struct LineWayResult {
  LineFigures figures;
  LossyProxy::Totals line;                             // datagrams of all kinds
  std::uint64_t undecoded = 0;                         // came, but referred to what had not
  std::uint64_t intra_frames = 0;                      // asked for by the hearer
  References references = References::kPreviousTwice;  // of the dancer, at the end
};

struct LineResult {
  std::string name;
  LineWayResult up, down;
  Duration round_trip;       // median of up and down together; 0 = unknown
  std::uint64_t lapses = 0;  // of the link behind the line
  std::uint64_t reconnects = 0;
  std::uint64_t missed_frames = 0;  // not danced or not shown, as this machine was late
  bool has_converged = false;       // each knows the other's presence and newest skeleton
  Duration converged_after;         // the last change
};

class LineLane {
 public:
  // Begins to dance at once: links meet whatever the line does just then.
  static Result<std::unique_ptr<LineLane>> open(const std::string& name, const LossyLine& line,
                                                const LineDance& dance, Duration span,
                                                Poller& poller);
  ~LineLane();
  LineLane(const LineLane&) = delete;
  LineLane& operator=(const LineLane&) = delete;

  bool has_converged() const;
  LineResult result() const;

 private:
  struct House {
    GuestId guest, other;
    const std::vector<Pose>* poses = nullptr;
    Skeleton skeleton;  // as it was sent last
    std::unique_ptr<Link> link;
    LineMeter* hears = nullptr;  // the way on which the other's poses come
    LineMeter* dances = nullptr;
    std::uint32_t sequence = 0;
    MonoTime next_pose, next_show;
    bool other_is_here = false;
    std::uint32_t others_skeleton = 0;  // version
  };

  LineLane(const std::string& name, const LineDance& dance, Duration span, Poller& poller);
  Result<void> open_ends(const LossyLine& line);
  Result<std::unique_ptr<Link>> open_link(House& house, const Address& server);
  LinkHandlers handlers_of(House& house);
  void send_skeleton(House& house, MonoTime now);
  void note_state(MonoTime now);
  MonoTime turn(MonoTime now);
  void dance_due(House& house, MonoTime now);
  void show_due(House& house, MonoTime now);
  bool is_due(MonoTime& next, Duration period, MonoTime now);
  LineWayResult way(const LineMeter& meter, LossyProxy::Direction direction, const House& dancer,
                    const House& hearer) const;

  std::string name_;
  const LineDance& dance_;
  Poller& poller_;
  MonoTime begin_, middle_, end_;
  LineMeter up_, down_;
  House lead_, follow_;
  LossyLine ways_;
  LinkKey key_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<LossyProxy> line_;
  Poller::TimerId timer_ = 0;
  bool is_changed_ = false, is_over_ = false;
  MonoTime changed_, converged_;
  std::uint64_t missed_frames_ = 0;
};

}  // namespace dance
