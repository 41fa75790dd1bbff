#include "research/rhythm/couple_film.h"

#include <gtest/gtest.h>

#include <map>

namespace dance {
namespace {

struct Counted : RecordingSink {
  void on_skeleton(const GuestId& guest, const Skeleton&, std::int64_t) override {
    ++skeletons[std::string(guest.view())];
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) override {
    EXPECT_TRUE(is_valid(pose));
    EXPECT_GE(time_us, last_us);
    last_us = time_us;
    poses[std::string(guest.view())].push_back(pose);
  }
  void on_hands(const GuestId&, const Hands&, std::int64_t) override { ADD_FAILURE(); }
  void on_beat(const Beat&, std::int64_t) override { ++beats; }

  std::map<std::string, int> skeletons;
  std::map<std::string, std::vector<Pose>> poses;
  int beats = 0;
  std::int64_t last_us = 0;
};

BeatGrid music() {
  std::vector<GridBeat> beats;
  for (int i = 0; i < 80; ++i) beats.push_back({60.0 / 180.0 * i, 0});
  return *BeatGrid::make(beats);
}

BeatDance salsa(SalsaRole role) {
  return salsa_to_music(role, 1, 0.0, Duration::s(15), music(), 60.0);
}

double last_apart_m(const Counted& film, const char* a, const char* b, float aside_m) {
  const Pose& x = film.poses.at(a).back();
  const Pose& y = film.poses.at(b).back();
  return static_cast<double>((x.p_WH_m + Eigen::Vector3f(aside_m, 0.0f, 0.0f) - y.p_WH_m).norm());
}

TEST(CoupleFilm, ShowsTheCoupleInEachWaySideBySide) {
  const BeatGrid grid = music();
  Counted film;
  const auto ways = usual_ways(true);
  ASSERT_EQ(ways.size(), 5u);
  ASSERT_TRUE(
      film_couple(salsa(SalsaRole::kLead), salsa(SalsaRole::kFollow), &grid, ways, {}, {}, film));
  EXPECT_EQ(film.poses.size(), 10u);
  EXPECT_GT(film.beats, 100);
  for (const auto& [name, poses] : film.poses) {
    EXPECT_GT(poses.size(), 850u) << name;
    EXPECT_EQ(film.skeletons[name], 1) << name;
  }
  // The one who dances here is the same in all, each further to the right.
  EXPECT_LT(last_apart_m(film, "here-raw", "here-danced", 4.0f * kBetween_m), 1e-4);
  // What came is old, what is predicted nearer to what is danced.
  EXPECT_LT(last_apart_m(film, "partner", "danced", 2.0f * kBetween_m),
            last_apart_m(film, "raw", "danced", 4.0f * kBetween_m));
}

TEST(CoupleFilm, NamesAWordThatIsNone) {
  Counted film;
  const auto filmed = film_couple(salsa(SalsaRole::kLead), salsa(SalsaRole::kFollow), nullptr,
                                  {{"one", {"foretell"}}}, {}, {}, film);
  ASSERT_FALSE(filmed);
  EXPECT_NE(filmed.error().what.find("foretell"), std::string::npos);
}

}  // namespace
}  // namespace dance
