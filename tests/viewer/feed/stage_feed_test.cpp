// The viewer's bus thread while the drawing thread waits in a driver, over real LCM.

#include "viewer/feed/stage_feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "tests/core/bus/bus_help.h"

namespace dance {
namespace {

TEST(StageFeed, HearsEveryPoseWhileTheDrawingThreadIsHeldUpInASwap) {
  FeedOptions options;
  options.bus_url = kUrl;
  auto feed = StageFeed::create(options);
  ASSERT_TRUE(feed) << feed.error().what;
  const auto sender = open_bus();
  const auto listener = open_bus();
  std::uint32_t shown = 0;
  listener->subscribe<StageTime>(Where::kView,
                                 [&](const Channel&, const StageTime&, MonoTime) { ++shown; });
  // This thread is the drawing one, and takes nothing: a driver has not come back from its swap.
  constexpr std::uint32_t kPoses = 500;
  for (std::uint32_t i = 0; i < kPoses; ++i) sender->publish(capture_of("alice"), numbered(i));
  // The feed's own thread is looked at through what it counts, until nothing more comes.
  std::uint64_t before = 0;
  for (int still = 0; still < 40 && (*feed)->board().poses() < kPoses; ++still) {
    poll(nullptr, 0, 50);
    if ((*feed)->board().poses() != before) still = 0;
    before = (*feed)->board().poses();
  }
  EXPECT_EQ((*feed)->board().poses(), kPoses);
  // The swap has come back: of what was reported meanwhile the newest are kept, and nothing waits.
  for (std::uint32_t i = 0; i < 2000; ++i) (*feed)->report_shown({guest("alice"), StageTime()});
  (*feed)->wake();
  drain_until(*listener, [&] { return shown >= 512; });
  EXPECT_GE(shown, 500u);
  EXPECT_LE(shown, 2000u);
  // And the newest pose is there, once.
  int news = 0;
  std::uint32_t newest = 0;
  for (std::size_t i = 0; i < GuestBoard::kMaxGuests; ++i)
    if (const GuestNews* it = (*feed)->board().take(i)) {
      ++news;
      newest = it->pose.sequence;
    }
  EXPECT_EQ(news, 1);
  EXPECT_EQ(newest, kPoses - 1);
}

// What came through the tunnel is heard for the board and for the instruments.
TEST(StageFeed, CountsEachPoseOfTheTunnelOnceWhicheverPosesAreShown) {
  for (const Shown shown : {Shown::kBest, Shown::kCapture, Shown::kGuest, Shown::kStage}) {
    FeedOptions options;
    options.bus_url = kUrl;
    options.shown = shown;
    auto feed = StageFeed::create(options);
    ASSERT_TRUE(feed) << feed.error().what;
    const auto sender = open_bus();
    const auto listener = open_bus();
    GuestStats stats;
    int seconds = 0;
    listener->subscribe<GuestStats>(Where::kView,
                                    [&](const Channel&, const GuestStats& told, MonoTime) {
                                      stats = told;
                                      ++seconds;
                                    });
    // One is lost, and one overtakes another: a meter tells by that one whether it hears twice.
    constexpr std::uint32_t kPoses = 50, kLost = 25, kOvertaken = 30;
    const Channel from = Channel::of(Signal::kPose, Where::kGuest, guest("bob"));
    for (std::uint32_t i = 0; i < kPoses; ++i) {
      const std::uint32_t sequence = i == kOvertaken       ? kOvertaken + 1
                                     : i == kOvertaken + 1 ? kOvertaken
                                                           : i;
      Pose pose = numbered(sequence);
      pose.capture_time = MonoTime::from_us(1'000'000 + 16'667 * std::int64_t{sequence});
      if (i != kLost) sender->publish(from, pose);
    }
    drain_until(*listener, [&] { return stats.received >= kPoses - 1 || seconds > 3; });
    EXPECT_EQ(stats.received, kPoses - 1) << static_cast<int>(shown);
    EXPECT_EQ(stats.lost, 1) << static_cast<int>(shown);
    EXPECT_EQ(stats.late, 1) << static_cast<int>(shown);
  }
}

TEST(StageFeed, TellsTheLinkWhomItsWindowHidesAndThatItIsThere) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  std::map<std::uint64_t, std::vector<InterestWish>> said;
  const auto house = HouseSocket::open(
      kUrl,
      [&](const Channel&, const Arrival& arrival) {
        InterestWish wish;
        ASSERT_EQ(decode(arrival.data, arrival.size, wish), Decoded::kFine);
        EXPECT_EQ(wish.clock_id, this_clock_id());
        said[wish.viewer].push_back(wish);
      },
      **poller);
  ASSERT_TRUE(house) << house.error().what;
  FeedOptions options;
  options.bus_url = kUrl;
  auto feed = StageFeed::create(options);
  auto other = StageFeed::create(options);
  ASSERT_TRUE(feed && other);
  (*feed)->dance().hide({guest("bob")});
  const auto hides = [&](const std::vector<InterestWish>& wishes) {
    return std::count_if(wishes.begin(), wishes.end(),
                         [](const InterestWish& wish) { return wish.hidden[0] == guest("bob"); });
  };
  const auto have_both_said = [&] {
    return said.size() == 2 && std::all_of(said.begin(), said.end(),
                                           [](const auto& of) { return of.second.size() >= 2; });
  };
  for (int i = 0; i < 3000 && !have_both_said(); ++i) (*poller)->run_once(Duration::ms(10));
  ASSERT_EQ(said.size(), 2u) << "each window has a name of its own";
  const auto first = hides(said.begin()->second), second = hides(said.rbegin()->second);
  EXPECT_EQ(std::min(first, second), 0) << "the other hides nobody, and says so";
  EXPECT_GE(std::max(first, second), 1);
}

}  // namespace
}  // namespace dance
