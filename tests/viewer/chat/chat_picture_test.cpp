// Tests pictures of the chat and of signs above heads; DANCE_PICTURES names a folder to keep them.
#include "tests/viewer/dance_panel/dance_stage.h"
#include "viewer/chat/chat_panel.h"

namespace dance {
namespace {

class ChatPicture : public DanceStage {
 protected:
  void begin_chat(Language language) {
    begin(language, kWidth_px, kHeight_px, 1.0f);
    ChatNeeds needs;
    needs.language = language;
    needs.writer = [] { return std::optional(guest_called("alice")); };
    needs.send = [](const GuestId&, ChatKind, std::string_view) {};
    panels_.add(std::make_unique<ChatPanel>(std::move(needs)));
    turn();
  }
  void write(const std::string& who, const std::string& text, Duration ago) {
    scene_.lines.push_back({guest_called(who), text, now_ - ago});
  }
  void type(std::string_view text) {
    for (const char letter : text) panels_.on_character(static_cast<unsigned char>(letter));
  }
};

TEST_F(ChatPicture, LinesAndTheFieldAreAtTheBottomLeft) {
  begin_chat(Language::kSpanish);
  const Picture before = keep("chat-none");
  write("bob",
        "\xc2\xbf"
        "Bailamos otra? Esta canci\xc3\xb3n me encanta, y la pr\xc3\xb3xima la "
        "ponemos un poco m\xc3\xa1s lenta para que todos puedan seguir el paso",
        Duration::s(4));
  write("alice", "\xc2\xa1S\xc3\xad!", Duration::s(1));
  const Picture lines = keep("chat-lines");
  EXPECT_GT(changed(before, lines, 0, kWidth_px / 2), 3000);
  EXPECT_EQ(changed(before, lines, 3 * kWidth_px / 4, kWidth_px), 0);
  EXPECT_TRUE(press(GLFW_KEY_ENTER));
  type("Dale, vamos");
  const Picture field = keep("chat-field");
  EXPECT_GT(changed(lines, field, 0, kWidth_px / 2), 3000);
}

TEST_F(ChatPicture, SignsAreAboveTheHeadsForTwoSeconds) {
  begin_chat(Language::kEnglish);
  const Picture before = draw();
  scene_.guests[0].sign = DanceSign::kHeart;
  scene_.guests[1].sign = DanceSign::kApplause;
  scene_.guests[0].sign_age_s = scene_.guests[1].sign_age_s = 0.6f;
  const Picture signs = keep("chat-signs");
  const auto of_heart = [](const Picture& picture) {
    int count = 0;
    for (int y = 0; y < picture.height_px; ++y)
      for (int x = 0; x < picture.width_px; ++x) {
        const auto pixel = picture.at(x, y);
        count += pixel[0] == 240 && pixel[1] == 70 && pixel[2] == 92 ? 1 : 0;
      }
    return count;
  };
  EXPECT_EQ(of_heart(before), 0);
  EXPECT_GT(of_heart(signs), 300);
  scene_.guests[0].sign_age_s = static_cast<float>(kSignHolds_s);
  EXPECT_EQ(of_heart(draw()), 0);
}

}  // namespace
}  // namespace dance
