// Golden messages of what parts of a house tell its windows.
#include "tests/core/bus/golden_files.h"

namespace dance {
namespace {

HouseLink golden_house_link() {
  HouseLink link;
  link.time = kCaptured;
  link.clock_id = kClock;
  link.state = HouseLinkState::kLapsed;
  link.trouble = HouseLinkTrouble::kRefused;
  link.refusal = 8;
  link.refused = *GuestId::parse("dora");
  link.asks_again = kCaptured + Duration::s(600);
  link.may_remove = true;
  link.removal = 77;
  link.verdict = RemovalVerdict::kPassedOn;
  return link;
}

Removal golden_removal() { return {kCaptured, kClock, 41, *GuestId::parse("bob-2")}; }

InterestWish golden_interest() {
  InterestWish wish{kCaptured, kClock, static_cast<std::uint64_t>(-2), {}};
  wish.hidden[0] = *GuestId::parse("alice");
  wish.hidden[7] = *GuestId::parse("bob-2");
  wish.hidden[23] = *GuestId::parse(std::string(24, 'c'));
  return wish;
}

RecordingState golden_recording() {
  return {kCaptured, kClock, static_cast<std::uint64_t>(-3), true};
}

VoiceLevel golden_voice_level() { return {kCaptured, kClock, -23, -31}; }

Face golden_face() {
  Face face;
  for (std::size_t i = 0; i < kExpressionCount; ++i) face.weight[i] = static_cast<float>(i) / 64.0f;
  face.gaze_rad = {0.25f, -0.5f};
  face.presence = kFaceSeen | kGazeSeen;
  face.sequence = 4'000'000'000u;
  face.clock_id = kClock;
  face.capture_time = kCaptured;
  return face;
}

Chat golden_chat() {
  Chat chat{kCaptured, kClock, ChatKind::kLine, {}};
  EXPECT_TRUE(
      chat.text.assign("\xc2\xbf"
                       "Bailas? \xf0\x9f\x92\x83"));
  return chat;
}

TEST(GoldenHouse, IsWrittenAndReadByteForByte) {
  expect_golden("chat_t", golden_chat());
  expect_golden("house_link_t", golden_house_link());
  expect_golden("removal_t", golden_removal());
  expect_golden("voice_level_t", golden_voice_level());
  expect_golden("interest_t", golden_interest());
  expect_golden("recording_t", golden_recording());
  expect_golden("face_t", golden_face());
}

TEST(GoldenHouse, SurvivesDamage) {
  expect_survives_bit_flips<Chat>("chat_t");
  expect_survives_bit_flips<Face>("face_t");
  expect_survives_bit_flips<HouseLink>("house_link_t");
  expect_survives_bit_flips<Removal>("removal_t");
  expect_survives_bit_flips<VoiceLevel>("voice_level_t");
  expect_survives_bit_flips<InterestWish>("interest_t");
  expect_survives_bit_flips<RecordingState>("recording_t");
}

TEST(GoldenHouse, TakesOnlyWhatTheTablesOfLinkAndRemovalHave) {
  const auto outcome_of = [](auto message) {
    const Bytes bytes = encoded(message);
    decltype(message) decoded;
    return decode(bytes.data(), bytes.size(), decoded);
  };
  HouseLink link = golden_house_link();
  link.trouble = static_cast<HouseLinkTrouble>(9);
  EXPECT_EQ(outcome_of(link), Decoded::kInvalid);
  link = golden_house_link();
  link.verdict = static_cast<RemovalVerdict>(-1);
  EXPECT_EQ(outcome_of(link), Decoded::kInvalid);
  Removal removal = golden_removal();
  removal.guest = GuestId();
  EXPECT_EQ(outcome_of(removal), Decoded::kInvalid) << "of nobody";
  removal = golden_removal();
  removal.number = 0;
  EXPECT_EQ(outcome_of(removal), Decoded::kInvalid) << "no number is no wish";
  InterestWish wish = golden_interest();
  wish.viewer = 0;
  EXPECT_EQ(outcome_of(wish), Decoded::kInvalid) << "of no window";
  VoiceLevel level = golden_voice_level();
  level.level_dbfs = 3;
  EXPECT_EQ(outcome_of(level), Decoded::kInvalid) << "louder than full scale";
}

TEST(GoldenHouse, DecodesOnlyValidChat) {
  const auto outcome_of = [](std::string_view text, ChatKind kind = ChatKind::kLine) {
    Chat chat{kCaptured, kClock, kind, {}};
    EXPECT_TRUE(chat.text.assign(text));
    const Bytes bytes = encoded(chat);
    return decode(bytes.data(), bytes.size(), chat);
  };
  const auto repeated = [](std::string_view text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
  };
  EXPECT_EQ(outcome_of("hola"), Decoded::kFine);
  EXPECT_EQ(outcome_of(repeated("\xc3\xb1", 200)), Decoded::kFine) << "200 characters of two bytes";
  EXPECT_EQ(outcome_of(repeated("x", 201)), Decoded::kInvalid) << "too many characters";
  for (const char* bad :
       {"", "   ", "a\nb", "a\x1b[2J", "a\x7f",
        "\xe2\x80\xae"
        "abc",
        "\xe2\x81\xa6", "\xd8\x9c", "\xef\xbb\xbf", "\xc0\xaf", "\xed\xa0\x80", "\xff", "abc\xc3"})
    EXPECT_EQ(outcome_of(bad), Decoded::kInvalid) << bad;
  EXPECT_EQ(outcome_of("", ChatKind::kHeart), Decoded::kFine);
  EXPECT_EQ(outcome_of("", ChatKind::kApplause), Decoded::kFine);
  EXPECT_EQ(outcome_of("x", ChatKind::kHeart), Decoded::kInvalid) << "signs have no text";
  EXPECT_EQ(outcome_of("", static_cast<ChatKind>(3)), Decoded::kInvalid);
  EXPECT_EQ(outcome_of("", static_cast<ChatKind>(-1)), Decoded::kInvalid);
}

}  // namespace
}  // namespace dance
