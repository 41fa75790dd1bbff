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

// A house in no room, which plays a file.
class DanceOwnSongTest : public DanceStage {
 protected:
  void SetUp() override {
    DanceStage::SetUp();
    if (IsSkipped()) return;
    is_in_room_ = false;
    begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
    publish(true);
    press(GLFW_KEY_ESCAPE);
    now_ += MusicDesk::kLook + Duration::ms(100);
    turn();
  }
  void publish(bool is_playing) {
    Music music;
    EXPECT_TRUE(music.title.assign("Quimbara - Celia Cruz"));
    music.playing = is_playing;
    board_.on_music(music);
    work();
  }
  bool is_asked(BandRequest request) const {
    return std::any_of(band_asked_.begin(), band_asked_.end(),
                       [&](const auto& asked) { return asked.first == request; });
  }
};

TEST_F(DanceOwnSongTest, IsStoppedPlayedOnAndChanged) {
  EXPECT_TRUE(find_with_mouse([&] { return is_asked(BandRequest::kPause); }));
  EXPECT_TRUE(find_with_mouse([&] { return is_asked(BandRequest::kNext); }));
  EXPECT_FALSE(is_asked(BandRequest::kPlay));
  publish(false);
  scene_.music.reset();
  EXPECT_TRUE(find_with_keys([&] { return is_asked(BandRequest::kPlay); }));
}

TEST_F(DanceOwnSongTest, IsMadeSlowerInStepsThatAreEachToldOnce) {
  EXPECT_TRUE(find_with_mouse([&] { return !speeds_told_.empty() && speeds_told_.back() < 0.8; }));
  for (std::size_t i = 0; i < speeds_told_.size(); ++i) {
    EXPECT_GE(speeds_told_[i], 0.5);
    EXPECT_LE(speeds_told_[i], 1.1);
    if (i > 0) {
      EXPECT_NE(speeds_told_[i], speeds_told_[i - 1]);
    }
  }
}

TEST_F(DanceOwnSongTest, ShowsThatItsBeatIsBeingFound) {
  const Picture danced = keep("panel-own-song");
  scene_.music.reset();
  const Picture finds = keep("panel-own-song-finds");
  publish(false);
  const Picture stopped = keep("panel-own-song-stopped");
  const int left = kWidth_px - 305;
  EXPECT_GT(changed(danced, finds, left, kWidth_px), 100);
  EXPECT_GT(changed(finds, stopped, left, kWidth_px), 100) << "a stopped song is not sought";
}

}  // namespace
}  // namespace dance
