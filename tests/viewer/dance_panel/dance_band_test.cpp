// Requests to the house band and to a synthetic dancer, made in the dance panel.
#include "tests/viewer/dance_panel/dance_stage.h"

namespace dance {
namespace {

class DanceBandTest : public DanceStage {
 protected:
  void SetUp() override {
    DanceStage::SetUp();
    if (IsSkipped()) return;
    begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
    RoomSong song;
    song.playing = true;
    song.style = 5;
    board_.on_song(song);
    Music music;
    board_.on_music(music);
    work();
    plays_music_ = true;
    press(GLFW_KEY_ESCAPE);
    now_ += MusicDesk::kLook + Duration::ms(100);
    turn();
  }
  bool is_asked(BandRequest request, int style) const {
    for (const auto& [asked, of] : band_asked_)
      if (asked == request && of == style) return true;
    return false;
  }
};

TEST_F(DanceBandTest, TheMouseReachesEachButtonOfTheBand) {
  for (const BandRequest request :
       {BandRequest::kNext, BandRequest::kSlower, BandRequest::kFaster, BandRequest::kPause})
    EXPECT_TRUE(find_with_mouse([&] { return is_asked(request, 5); })) << static_cast<int>(request);
  EXPECT_TRUE(find_with_mouse([&] { return is_asked(BandRequest::kStyle, 6); }));
  keep("panel-band");
}

TEST_F(DanceBandTest, OffersTheLockToAHostOnly) {
  EXPECT_TRUE(find_with_mouse([&] { return is_asked(BandRequest::kLock, 5); }));
  RoomSong song;
  song.playing = song.locked = true;
  board_.on_song(song);
  work();
  EXPECT_TRUE(find_with_mouse([&] { return is_asked(BandRequest::kUnlock, 0); }));
  keep("panel-band-locked");
  band_asked_.clear();
  link_->may_remove = false;
  work();
  EXPECT_FALSE(find_with_mouse([&] { return is_asked(BandRequest::kUnlock, 0); }));
}

TEST_F(DanceBandTest, OneKeyMutesTheMusicHereAndPlaysItAgain) {
  music_told_.clear();
  EXPECT_TRUE(press(GLFW_KEY_Y));
  EXPECT_EQ(music_told_, std::vector<double>{0.0});
  EXPECT_TRUE(press(GLFW_KEY_Y));
  EXPECT_EQ(music_told_, (std::vector<double>{0.0, 0.6}));
  now_ += Duration::s(2);
  turn();
  EXPECT_TRUE(music_kept_.empty()) << "the next dance has music";
  plays_music_ = false;
  press(GLFW_KEY_Y);
  EXPECT_EQ(music_told_.size(), 2u) << "no music plays here";
}

TEST_F(DanceBandTest, OffersPlayWhenTheSongIsStopped) {
  RoomSong song;
  song.playing = false;
  board_.on_song(song);
  work();
  EXPECT_TRUE(find_with_mouse([&] { return is_asked(BandRequest::kPlay, 0); }));
  EXPECT_FALSE(is_asked(BandRequest::kPause, 0));
}

TEST_F(DanceBandTest, OffersNothingWithoutTheBand) {
  plays_music_ = false;
  now_ += MusicDesk::kLook + Duration::ms(100);
  turn();
  EXPECT_FALSE(find_with_mouse([&] { return !band_asked_.empty(); }));
}

TEST_F(DanceBandTest, SendsTheRoleOfASyntheticDancerOfThisHouse) {
  panel_->choose(guest_called("alice"));
  turn();
  for (const char* role : {"lead", "follow", "any"})
    EXPECT_TRUE(find_with_keys([&] {
      return std::find(roles_sent_.begin(), roles_sent_.end(), "alice: " + std::string(role)) !=
             roles_sent_.end();
    })) << role;
  for (const std::string& sent : roles_sent_) EXPECT_TRUE(sent.starts_with("alice")) << sent;
}

}  // namespace
}  // namespace dance
