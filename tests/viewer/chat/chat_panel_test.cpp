// Tests the keys of the chat panel.
#include "viewer/chat/chat_panel.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <set>
#include <vector>

#include "viewer/panel/panel_stack.h"

namespace dance {
namespace {

GuestId guest_named(const std::string& name) { return *GuestId::parse(name); }

class ChatPanels : public ::testing::Test {
 protected:
  ChatPanels() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {1280.0f, 720.0f};
    font_ = io.Fonts->AddFontDefault();
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    scene_.time = MonoTime::from_us(1'000'000'000);
  }
  ~ChatPanels() override { ImGui::DestroyContext(); }

  void begin(bool can_write = true) {
    ChatNeeds needs;
    needs.writer = [this] { return writer_; };
    if (can_write)
      needs.send = [this](const GuestId& who, ChatKind kind, std::string_view text) {
        sent_.push_back(std::string(who.view()) +
                        (kind == ChatKind::kLine    ? ": "
                         : kind == ChatKind::kHeart ? " <3"
                                                    : " claps") +
                        std::string(text));
      };
    needs.is_hidden = [this](const GuestId& who) { return hidden_.contains(who); };
    auto panel = std::make_unique<ChatPanel>(std::move(needs));
    panel_ = panel.get();
    panels_.add(std::move(panel));
    draw();
  }
  bool press(int key, bool has_control = false) {
    return panels_.on_key({key, false, false, has_control});
  }
  void type(std::string_view text) {
    for (const char letter : text) panels_.on_character(static_cast<unsigned char>(letter));
  }
  // Returns the number of vertices that the panel drew.
  int draw(Duration after = Duration::ms(16)) {
    scene_.time += after;
    ImGui::NewFrame();
    PanelFrame frame{scene_, 1280.0f, 720.0f};
    frame.large_font = frame.small_font = font_;
    panels_.draw(frame);
    ImGui::Render();
    return ImGui::GetDrawData()->TotalVtxCount;
  }
  void write(const std::string& who, const std::string& text) {
    scene_.lines.push_back({guest_named(who), text, scene_.time});
  }

  ImFont* font_ = nullptr;
  SceneState scene_;
  PanelStack panels_;
  ChatPanel* panel_ = nullptr;
  std::optional<GuestId> writer_ = guest_named("alice");
  std::set<GuestId> hidden_;
  std::vector<std::string> sent_;
};

TEST_F(ChatPanels, EnterOpensAndSendsAndEscCloses) {
  begin();
  EXPECT_FALSE(panels_.on_character(U'x')) << "the field is closed";
  ASSERT_TRUE(press(GLFW_KEY_ENTER));
  EXPECT_TRUE(panel_->is_open());
  type("hola a todos");
  EXPECT_TRUE(press(GLFW_KEY_ENTER));
  EXPECT_EQ(sent_, std::vector<std::string>{"alice: hola a todos"});
  EXPECT_TRUE(panel_->is_open()) << "for the next line";
  EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
  EXPECT_FALSE(panel_->is_open());
  EXPECT_FALSE(press(GLFW_KEY_ESCAPE)) << "the next one is another panel's";
}

TEST_F(ChatPanels, KeysOfTheWindowAreOffWhileTheFieldIsOpen) {
  begin();
  press(GLFW_KEY_ENTER);
  for (const int key : {GLFW_KEY_Q, GLFW_KEY_M, GLFW_KEY_A, GLFW_KEY_L, GLFW_KEY_F1, GLFW_KEY_TAB})
    EXPECT_TRUE(press(key)) << key;
  EXPECT_TRUE(sent_.empty());
  type("Quema la");
  press(GLFW_KEY_BACKSPACE);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(sent_, std::vector<std::string>{"alice: Quema l"});
}

TEST_F(ChatPanels, ASecondLineWaitsUntilASecondHasPassed) {
  begin();
  press(GLFW_KEY_ENTER);
  type("one");
  press(GLFW_KEY_ENTER);
  type("two");
  press(GLFW_KEY_ENTER);
  draw(Duration::ms(500));
  EXPECT_EQ(sent_.size(), 1u);
  draw(Duration::ms(600));
  EXPECT_EQ(sent_, (std::vector<std::string>{"alice: one", "alice: two"}));
  draw(Duration::s(2));
  EXPECT_EQ(sent_.size(), 2u);
  type("three");
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(sent_.size(), 3u);
}

TEST_F(ChatPanels, EnterWithoutWordsCloses) {
  begin();
  press(GLFW_KEY_ENTER);
  type("   ");
  press(GLFW_KEY_ENTER);
  EXPECT_FALSE(panel_->is_open());
  press(GLFW_KEY_ENTER);
  press(GLFW_KEY_ENTER);
  EXPECT_FALSE(panel_->is_open());
  EXPECT_TRUE(sent_.empty());
}

TEST_F(ChatPanels, SignsAreASecondApart) {
  begin();
  EXPECT_TRUE(press(GLFW_KEY_L));
  EXPECT_TRUE(press(GLFW_KEY_A));
  EXPECT_FALSE(press(GLFW_KEY_A, true)) << "Ctrl+A is no applause";
  draw(Duration::ms(1100));
  press(GLFW_KEY_A);
  EXPECT_EQ(sent_, (std::vector<std::string>{"alice <3", "alice claps"}));
}

TEST_F(ChatPanels, WithoutADancerNothingIsSentAndTheTextStays) {
  begin();
  writer_.reset();
  press(GLFW_KEY_L);
  press(GLFW_KEY_ENTER);
  type("wait");
  press(GLFW_KEY_ENTER);
  draw(Duration::s(1));
  EXPECT_TRUE(sent_.empty());
  writer_ = guest_named("bob");
  draw();
  EXPECT_EQ(sent_, std::vector<std::string>{"bob: wait"}) << "as soon as one is here";
}

TEST_F(ChatPanels, LinesAreShownForSecondsAndTheLastOnesWhileTheFieldIsOpen) {
  begin();
  const int nothing = draw();
  write("bob", "hey");
  const int one = draw();
  EXPECT_GT(one, nothing);
  for (int i = 0; i < 10; ++i) write("bob", "hey");
  const int few = draw();
  EXPECT_EQ(few - nothing, 4 * (one - nothing)) << "the newest four";
  draw(ChatPanel::kFresh);
  EXPECT_EQ(draw(), nothing) << "they are old";
  press(GLFW_KEY_ENTER);
  const int open = draw();
  EXPECT_GT(open, few) << "all eleven, and the field";
  hidden_.insert(guest_named("bob"));
  EXPECT_LT(draw(), open);
  press(GLFW_KEY_ESCAPE);
  write("bob", "you");
  EXPECT_EQ(draw(), nothing) << "nothing of a guest whom this person has muted";
  write("carla", "hey");
  EXPECT_GT(draw(), nothing);
}

TEST_F(ChatPanels, ARecordingHasNoField) {
  begin(false);
  EXPECT_FALSE(press(GLFW_KEY_ENTER));
  EXPECT_FALSE(press(GLFW_KEY_L));
  EXPECT_TRUE(panel_->keys().empty());
  const int nothing = draw();
  write("bob", "hey");
  EXPECT_GT(draw(), nothing);
}

}  // namespace
}  // namespace dance
