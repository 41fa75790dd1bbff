// What a panel saves: the values come back, and all else of the file stays as it was.
#include "formats/session/session_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "house/session.h"
#include "transformers/flow.h"
#include "transformers/flow_text.h"

namespace dance {
namespace {

constexpr const char* kFile = R"(# Alice's house.  Frühling, "quotes" and [[brackets]] in a comment
[house]
guest  = "alice"          # me
room   = "salsa"

# my own
[[route]]
from = "POSE/capture/alice"
to   = "POSE/stage/alice"

[[route]]   # the others
from    = "POSE/guest/*"
through = ["predict most=250ms", # as far as it is good
           'bridge blend=40ms',
           "rhythm beats=1",   "stylize preset=cuban mix=0.25"]   # größer
to      = "POSE/stage/*"
rate    = 60    # a second
)";

struct TemporaryFile {
  explicit TemporaryFile(const std::string& text)
      : path(std::string(::testing::TempDir()) + "session-" +
             ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml") {
    write(text);
  }
  ~TemporaryFile() {
    chmod(path.c_str(), 0600);
    std::filesystem::remove(path);
  }
  void write(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }
  std::string read() const {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  std::string path;
};

SessionEdit words_of_route_1(std::vector<WordEdit> words) {
  SessionEdit edit;
  edit.route = 1;
  edit.words = std::move(words);
  return edit;
}

TEST(SessionEdit, ReplacesTheTextOfTheWordsThatChangeAndNothingElse) {
  const auto edited = edit_session(
      kFile,
      words_of_route_1({{"rhythm", "rhythm beats=2 strength=0.5"}, {"bridge", "bridge on=0"}}),
      "s.toml");
  ASSERT_TRUE(edited) << edited.error().what;
  std::string expected = kFile;
  expected.replace(expected.find("\"rhythm beats=1\""), 16, "\"rhythm beats=2 strength=0.5\"");
  expected.replace(expected.find("'bridge blend=40ms'"), 19, "\"bridge on=0\"");
  EXPECT_EQ(*edited, expected);
}

TEST(SessionEdit, LeavesATextWithoutChangesAsItIs) {
  EXPECT_EQ(edit_session(kFile, words_of_route_1({{"rhythm", "rhythm beats=1"}}), "s").value(),
            kFile);
}

TEST(SessionEdit, AddsTheStyleOfAGuestOnceAndChangesItThen) {
  SessionEdit edit;
  edit.style = StyleEdit{"alice", "hips=1.5"};
  const std::string once = edit_session(kFile, edit, "s").value();
  EXPECT_EQ(once, std::string(kFile) + "\n[[style]]\nguest = \"alice\"\nwords = \"hips=1.5\"\n");
  edit.style->words = "preset=calm mix=0.5";
  const std::string twice = edit_session(once, edit, "s").value();
  EXPECT_EQ(twice, std::string(kFile) +
                       "\n[[style]]\nguest = \"alice\"\nwords = \"preset=calm mix=0.5\"\n");
  const auto session = parse_session(twice, "s");
  ASSERT_TRUE(session) << session.error().what;
  ASSERT_EQ(session->styles.size(), 1u);
  EXPECT_EQ(session->styles[0].style.gain[0], 0.7f);
  EXPECT_EQ(session->styles[0].style.dynamic, 0.5f);
}

TEST(SessionEdit, WritesTheUsualRoutesWhereThereAreNone) {
  const std::string text = "[house]\nguest = \"alice\"";  // and no end of line
  const auto edited =
      edit_session(text, words_of_route_1({{"predict", "predict lead=0.5"}}), "s.toml");
  ASSERT_TRUE(edited) << edited.error().what;
  EXPECT_TRUE(edited->starts_with(text));
  const auto before = parse_session(text, "s.toml"), after = parse_session(*edited, "s.toml");
  ASSERT_TRUE(after) << after.error().what;
  ASSERT_EQ(after->routes.size(), before->routes.size());
  for (std::size_t i = 0; i < after->routes.size(); ++i) {
    EXPECT_EQ(after->routes[i].from.where, before->routes[i].from.where);
    EXPECT_EQ(after->routes[i].rate_hz, before->routes[i].rate_hz);
  }
  EXPECT_EQ(after->routes[1].through[0], "predict lead=0.5");
  EXPECT_EQ(after->routes[1].through[1], before->routes[1].through[1]);
}

TEST(SessionEdit, NamesWhatHasNoPlaceInTheFile) {
  const auto error_of = [](const SessionEdit& edit, const char* text) {
    const auto edited = edit_session(text, edit, "s.toml");
    return edited ? std::string("none") : edited.error().what;
  };
  EXPECT_NE(error_of(words_of_route_1({{"hold", "hold 20ms"}}), kFile).find("s.toml:13"),
            std::string::npos);
  SessionEdit third = words_of_route_1({{"predict", "predict"}});
  third.route = 2;
  EXPECT_NE(error_of(third, kFile).find("no route 3"), std::string::npos);
  third.route = 0;
  EXPECT_NE(error_of(third, kFile).find("through"), std::string::npos);
  EXPECT_NE(error_of(third, "[house\n").find("s.toml:1"), std::string::npos);
  third.words[0].text = "predict lead=0.5";
  EXPECT_NE(error_of(third, "[[route]]\nthrough = [\"\"\"predict\"\"\"]\n").find("on one line"),
            std::string::npos);
}

// Damaged sessions: an error or a text that holds the values; never a crash.
TEST(SessionEdit, SurvivesEveryPrefixAndEveryChangedByte) {
  const std::string text = kFile;
  const SessionEdit edit = words_of_route_1({{"rhythm", "rhythm beats=2"}});
  for (std::size_t size = 0; size < text.size(); ++size)
    (void)edit_session(text.substr(0, size), edit, "s");
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const char c : {'"', '\'', '\n', '\\', '[', ']', '\0', '\xff'}) {
      std::string damaged = text;
      damaged[i] = c;
      const auto edited = edit_session(damaged, edit, "s");
      if (!edited) continue;
      const auto words = route_words(*edited, 1, "s");
      ASSERT_TRUE(words);
      EXPECT_NE(std::find(words->begin(), words->end(), "rhythm beats=2"), words->end());
    }
  }
}

TEST(SessionFile, ReadBackGivesTheSameValues) {
  const TemporaryFile file(kFile);
  SessionFile session = *SessionFile::open(file.path);
  FlowSetting wanted = Flow::make(session.words(1))->setting();
  wanted.lead = 0.85f;
  wanted.reach_ms = 180.0f;
  wanted.on[index_of(FlowWord::kBridge)] = false;
  wanted.rhythm_beats = 3.0f;
  wanted.rhythm_count = 4.0f;
  wanted.rhythm_strength = 0.25f;
  wanted.gain = {1.25f, 0.5f, 1.0f, 2.0f, 3.0f, 0.0f, 0.75f};
  wanted.periodic = 0.5f;
  wanted.dynamic = 0.75f;
  std::vector<WordEdit> edits;
  for (std::size_t word = 1; word < kFlowWords; ++word)
    edits.push_back({std::string(kFlowWordNames[word]),
                     word_text(static_cast<FlowWord>(word), wanted, session.words(1)[word - 1])});
  ASSERT_TRUE(session.save(words_of_route_1(edits)));
  const auto read = load_session(file.path);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_TRUE(is_same_setting(Flow::make(read->routes[1].through)->setting(), wanted));
  EXPECT_EQ(read->routes[1].through[1], "bridge blend=40ms on=0");
  for (const char* comment :
       {"# Alice's house.  Frühling, \"quotes\" and [[brackets]]", "# me\n", "# my own\n",
        "# the others\n", "# as far as it is good\n", "# größer\n", "# a second\n"})
    EXPECT_NE(file.read().find(comment), std::string::npos) << comment;
}

TEST(SessionFile, RefusesWhenSomebodyElseChangedItAndSavesWhenToldAgain) {
  const TemporaryFile file(kFile);
  SessionFile session = *SessionFile::open(file.path);
  const std::string changed = std::string(kFile) + "# and somebody's note\n";
  file.write(changed);
  const SessionEdit edit = words_of_route_1({{"rhythm", "rhythm beats=2"}});
  const auto refused = session.save(edit);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("was changed"), std::string::npos);
  EXPECT_EQ(file.read(), changed) << "nothing was written";
  ASSERT_TRUE(session.save(edit));
  EXPECT_NE(file.read().find("# and somebody's note"), std::string::npos);
  EXPECT_NE(file.read().find("rhythm beats=2"), std::string::npos);
}

// In a process of its own, as root may write everything.
TEST(SessionFileDeathTest, RefusesAFileThatIsNotToBeWritten) {
  const TemporaryFile file(kFile);
  chmod(file.path.c_str(), 0444);
  const auto save_as_nobody = [&] {
    constexpr uid_t kNobody = 65534;
    if (geteuid() == 0 && setuid(kNobody) != 0) std::exit(3);
    SessionFile session = *SessionFile::open(file.path);
    const auto refused = session.save(words_of_route_1({{"rhythm", "rhythm beats=2"}}));
    std::exit(!refused && refused.error().what.find("chmod") != std::string::npos ? 0 : 1);
  };
  EXPECT_EXIT(save_as_nobody(), ::testing::ExitedWithCode(0), "");
  EXPECT_EQ(file.read(), kFile);
}

TEST(SessionFile, KeepsHowLoudTheMusicIsInItsTable) {
  const std::string music = "[house]\nguest = \"ann\"\n[music]\nfile = \"a.ogg\"  # ours\n";
  const TemporaryFile file(music);
  auto opened = SessionFile::open(file.path);
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->music_volume(), 1.0);
  ASSERT_TRUE(opened->save_music_volume(0.35000001));
  EXPECT_EQ(file.read(), music + "volume = 0.35\n");
  EXPECT_EQ(opened->music_volume(), 0.35);
  EXPECT_EQ(load_session(file.path)->music->volume, 0.35);
  ASSERT_TRUE(opened->save_music_volume(0.0));
  EXPECT_EQ(load_session(file.path)->music->volume, 0.0);
  // Where only what is practised to stands in it.
  file.write("[house]\nguest = \"ann\"\n[window]\nmusic = \"b.ogg\"\n");
  opened = SessionFile::open(file.path);
  ASSERT_TRUE(opened->save_music_volume(0.6));
  EXPECT_EQ(load_session(file.path)->practice_volume, 0.6);
  file.write("[house]\nguest = \"ann\"\n");
  opened = SessionFile::open(file.path);
  const auto refused = opened->save_music_volume(0.6);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("no [music]"), std::string::npos);
}

TEST(SessionFile, NamesAFileThatIsNotThereOrIsNoSession) {
  EXPECT_FALSE(SessionFile::open("/nowhere/s.toml"));
  const TemporaryFile file("[[route]\n");
  const auto opened = SessionFile::open(file.path);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find(":1:"), std::string::npos);
}

TEST(FlowText, SaysWhatFlowWordsRead) {
  FlowSetting setting;
  setting.has.fill(true);
  setting.hold_ms = 40.0f;
  setting.gain[6] = 0.0f;
  EXPECT_EQ(word_text(FlowWord::kHold, setting, ""), "hold 40ms");
  EXPECT_EQ(word_text(FlowWord::kPredict, setting, ""), "predict");
  EXPECT_EQ(word_text(FlowWord::kRhythm, setting, "rhythm beats=2"), "rhythm");
  EXPECT_EQ(word_text(FlowWord::kStylize, setting, ""), "stylize head=0");
  EXPECT_EQ(word_text(FlowWord::kPredict, setting, "predict  lead=1.0"), "predict  lead=1.0")
      << "what says the same stays";
  EXPECT_EQ(word_text(FlowWord::kPredict, setting, "predict lead=nonsense"), "predict");
}

}  // namespace
}  // namespace dance
