#include "apps/crowd/crowd_plan.h"

#include <gtest/gtest.h>

#include <set>

namespace dance {
namespace {

CrowdPlan plan_of(std::size_t guests, std::size_t rooms, std::size_t servers) {
  CrowdPlan plan;
  plan.guests = guests;
  plan.rooms = rooms;
  for (std::size_t i = 0; i < servers; ++i) plan.servers.push_back("s" + std::to_string(i));
  return plan;
}

TEST(CrowdPlan, DealsGuestsEvenlyOverRoomsAndServers) {
  const CrowdPlan plan = plan_of(23, 4, 3);
  std::set<std::pair<std::size_t, std::size_t>> seen;
  std::vector<std::size_t> in_room(4), on_server_in_first_room(3);
  for (std::size_t guest = 0; guest < plan.guests; ++guest) {
    const std::size_t room = plan.room_of(guest), place = plan.place_of(guest);
    EXPECT_TRUE(seen.emplace(room, place).second) << guest;
    EXPECT_EQ(plan.guest_at(room, place), guest);
    EXPECT_LT(place, plan.guests_per_room());
    ++in_room[room];
    if (room == 0) ++on_server_in_first_room[plan.server_of(guest)];
  }
  EXPECT_EQ(in_room, (std::vector<std::size_t>{6, 6, 6, 5}));
  EXPECT_EQ(on_server_in_first_room, (std::vector<std::size_t>{2, 2, 2}));
}

TEST(CrowdPlan, KnowsItsGuestsByName) {
  CrowdPlan plan = plan_of(12, 1, 1);
  plan.name = "alice-b";
  for (std::size_t place = 0; place < 12; ++place)
    EXPECT_EQ(plan.place_of(plan.guest_name(place)), place);
  for (const char* other : {"alice-b", "alice-b-0", "alice-b-13", "alice-b-01", "alice-c-1",
                            "alice-b-1x", "alice-bc-1", "alice-b-99999999999"}) {
    const auto guest = GuestId::parse(other);
    ASSERT_TRUE(guest) << other;
    EXPECT_EQ(plan.place_of(*guest), std::nullopt) << other;
  }
}

TEST(CrowdPlan, NumbersRoomsWhereThereAreSeveral) {
  EXPECT_EQ(plan_of(4, 1, 1).room_name(0).view(), "crowd");
  EXPECT_EQ(plan_of(4, 2, 1).room_name(1).view(), "crowd-2");
}

TEST(CrowdPlan, SaysWhatDoesNotFit) {
  const auto error_of = [](const CrowdPlan& plan) {
    const auto checked = checked_plan(plan);
    return checked ? std::string() : checked.error().what;
  };
  EXPECT_EQ(error_of(plan_of(wire::kMaxGuestsPerRoom, 1, 1)), "");
  EXPECT_NE(error_of(plan_of(wire::kMaxGuestsPerRoom + 1, 1, 1)).find("--rooms"),
            std::string::npos);
  EXPECT_EQ(error_of(plan_of(wire::kMaxGuestsPerRoom + 1, 2, 1)), "");
  EXPECT_NE(error_of(plan_of(2, 3, 1)).find("empty"), std::string::npos);
  CrowdPlan plan = plan_of(100, 10, 1);
  plan.room = "a-very-long-name-of-ro";  // with -9 it fits, with -10 it does not
  EXPECT_NE(error_of(plan).find("--room"), std::string::npos);
  plan.rooms = 9;
  EXPECT_EQ(error_of(plan), "");
  plan.name = "No";
  EXPECT_NE(error_of(plan).find("--name"), std::string::npos);
  plan = plan_of(10, 1, 1);
  plan.churn = plan.join_rate + 1.0;
  EXPECT_NE(error_of(plan).find("--churn"), std::string::npos);
}

}  // namespace
}  // namespace dance
