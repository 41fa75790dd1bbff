// Messages about guests who join or leave.
#include "viewer/dance_panel/arrivals.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

GuestId arrival_named(const char* name) { return *GuestId::parse(name); }

// A room whose link publishes some guests once a second.
struct NamingRoom {
  std::string run(Duration duration) {
    std::string announced;
    for (const MonoTime end = now + duration; now < end; now += Duration::ms(500)) {
      HouseLink link;
      link.state = is_connected ? HouseLinkState::kConnected : HouseLinkState::kLapsed;
      board.on_link(link, now);
      for (const char* name : here)
        if (is_connected) board.on_traffic(arrival_named(name), now);
      records.take(board, now);
      arrivals.work(records, now);
      for (const Arrivals::Message& message : arrivals.messages())
        if (message.at == now)
          announced += (message.has_joined ? "+" : "-") + std::string(message.guest.view()) + " ";
    }
    return announced;
  }

  DanceBoard board;
  DanceRecords records;
  Arrivals arrivals;
  std::vector<const char*> here{"alice", "bob"};
  bool is_connected = true;
  MonoTime now = MonoTime::from_us(100'000'000);
};

TEST(Arrivals, AnnouncesGuestsWhoJoinOrLeaveButNotThosePresentAtTheStart) {
  NamingRoom room;
  EXPECT_EQ(room.run(Duration::s(8)), "");
  room.here = {"alice", "bob", "carla"};
  EXPECT_EQ(room.run(Duration::s(2)), "+carla ");
  EXPECT_EQ(room.arrivals.messages().size(), 1u) << "still shown";
  room.here = {"bob", "carla"};
  EXPECT_EQ(room.run(Duration::s(8)), "-alice ");
  room.run(Duration::s(4));
  EXPECT_TRUE(room.arrivals.messages().empty());
}

TEST(Arrivals, AnnouncesNobodyWhileTheLinkIsDown) {
  NamingRoom room;
  room.run(Duration::s(8));
  room.is_connected = false;
  EXPECT_EQ(room.run(Duration::s(30)), "");
  room.is_connected = true;
  EXPECT_EQ(room.run(Duration::s(8)), "") << "the same two are there";
  room.is_connected = false;
  room.run(Duration::s(30));
  room.here = {"bob"};
  room.is_connected = true;
  EXPECT_EQ(room.run(Duration::s(8)), "-alice ");
}

TEST(Arrivals, ShowsTheNewestThreeMessages) {
  NamingRoom room;
  room.here = {};
  room.run(Duration::s(8));
  room.here = {"ann", "ben", "cid", "dan", "eve"};
  room.run(Duration::s(1));
  EXPECT_EQ(room.arrivals.messages().size(), Arrivals::kMostShown);
}

TEST(Arrivals, IgnoresGuestsOfThisHouse) {
  NamingRoom room;
  room.run(Duration::s(8));
  GuestStatus own;
  own.alive = true;
  room.board.on_status(arrival_named("amy"), own, room.now);
  EXPECT_EQ(room.run(Duration::s(3)), "");
}

}  // namespace
}  // namespace dance
