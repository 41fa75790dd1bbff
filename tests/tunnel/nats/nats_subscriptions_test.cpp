// What is said to NATS about subjects: little, however often wishes change, and nothing of one
// subject is taken for another.
#include "tunnel/nats/messages/nats_subscriptions.h"

#include <gtest/gtest.h>

#include <set>

namespace dance {
namespace {

const MonoTime kBegin = MonoTime() + Duration::s(100);

std::vector<NatsSubscriptions::Line> lines_of(NatsSubscriptions& subjects) {
  std::vector<NatsSubscriptions::Line> lines;
  while (const auto line = subjects.take_line()) lines.push_back(*line);
  return lines;
}
std::uint32_t number_of(NatsSubscriptions& subjects, std::string_view subject) {
  EXPECT_TRUE(subjects.listen(subject));
  const auto line = subjects.take_line();
  EXPECT_TRUE(line && line->subject == subject) << subject;
  return line ? line->number : 0;
}

TEST(NatsSubscriptions, TogglingSaysNothing) {
  NatsSubscriptions subjects;
  const std::uint32_t number = number_of(subjects, "a");
  for (int i = 0; i < 10'000; ++i) {
    const MonoTime now = kBegin + Duration::ms(i);
    subjects.end_listen("a", now);
    EXPECT_FALSE(subjects.is_wanted(number));
    if (i % 100 == 0) subjects.settle(now);
    EXPECT_TRUE(subjects.listen("a"));
    EXPECT_TRUE(subjects.is_wanted(number));
    ASSERT_FALSE(subjects.take_line());
  }
  subjects.settle(kBegin + Duration::s(60));
  EXPECT_TRUE(lines_of(subjects).empty());
  EXPECT_TRUE(subjects.is_wanted(number));
}

TEST(NatsSubscriptions, AnEndIsSaidOnceAndAfterAWhile) {
  NatsSubscriptions subjects;
  const std::uint32_t number = number_of(subjects, "a");
  subjects.end_listen("a", kBegin);
  subjects.settle(kBegin + NatsSubscriptions::kHeld - Duration::ms(1));
  EXPECT_TRUE(lines_of(subjects).empty());
  subjects.settle(kBegin + NatsSubscriptions::kHeld);
  const auto lines = lines_of(subjects);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].subject, "");
  EXPECT_EQ(lines[0].number, number);
  subjects.settle(kBegin + Duration::s(60));
  EXPECT_TRUE(lines_of(subjects).empty());
  EXPECT_EQ(subjects.size(), 0u);
  // One whose beginning was never said needs no end.
  EXPECT_TRUE(subjects.listen("b"));
  subjects.end_listen("b", kBegin);
  EXPECT_TRUE(lines_of(subjects).empty());
  subjects.settle(kBegin + Duration::s(60));
  EXPECT_TRUE(lines_of(subjects).empty());
  EXPECT_EQ(subjects.size(), 0u);
}

TEST(NatsSubscriptions, AWishThatChangesBeforeItIsSaidIsSaidAsItIsNow) {
  NatsSubscriptions subjects;
  number_of(subjects, "a");
  subjects.end_listen("a", kBegin);
  subjects.settle(kBegin + Duration::s(2));  // the end waits to be said
  EXPECT_TRUE(subjects.listen("a"));
  EXPECT_TRUE(lines_of(subjects).empty());
  subjects.end_listen("a", kBegin + Duration::s(3));
  EXPECT_TRUE(subjects.listen("b"));
  subjects.end_listen("b", kBegin + Duration::s(3));
  EXPECT_TRUE(subjects.listen("b"));
  const auto lines = lines_of(subjects);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].subject, "b");
}

TEST(NatsSubscriptions, ANumberIsNotGivenAgainToAnotherSubject) {
  NatsSubscriptions subjects;
  std::set<std::uint32_t> numbers;
  MonoTime now = kBegin;
  for (int i = 0; i < 1000; ++i) {
    const std::string subject = "guest-" + std::to_string(i);
    const std::uint32_t number = number_of(subjects, subject);
    EXPECT_TRUE(numbers.insert(number).second) << "what is on its way would be another's";
    EXPECT_GT(number, 0u);
    subjects.end_listen(subject, now);
    now = now + Duration::s(2);
    subjects.settle(now);
    EXPECT_EQ(lines_of(subjects).size(), 1u);
    EXPECT_FALSE(subjects.is_wanted(number));
    ASSERT_EQ(subjects.size(), 0u);
  }
  EXPECT_FALSE(subjects.is_wanted(0));
  EXPECT_FALSE(subjects.is_wanted(UINT32_MAX));
}

TEST(NatsSubscriptions, ThereAreAtMostSoMany) {
  NatsSubscriptions subjects;
  for (std::size_t i = 0; i < NatsSubscriptions::kMost; ++i)
    ASSERT_TRUE(subjects.listen(std::to_string(i)));
  EXPECT_FALSE(subjects.listen("one more"));
  EXPECT_TRUE(subjects.listen("0")) << "that it has";
  EXPECT_EQ(lines_of(subjects).size(), NatsSubscriptions::kMost);
  subjects.end_listen("0", kBegin);
  subjects.settle(kBegin + Duration::s(2));
  EXPECT_EQ(lines_of(subjects).size(), 1u);
  EXPECT_TRUE(subjects.listen("one more"));
}

TEST(NatsSubscriptions, AnotherConnectionIsToldWhatIsWanted) {
  NatsSubscriptions subjects;
  for (const char* subject : {"a", "b", "c"}) number_of(subjects, subject);
  subjects.end_listen("b", kBegin);
  subjects.begin();
  std::set<std::string> said;
  for (const auto& line : lines_of(subjects)) said.emplace(line.subject);
  EXPECT_EQ(said, (std::set<std::string>{"a", "c"}));
  subjects.settle(kBegin + Duration::s(60));
  EXPECT_TRUE(lines_of(subjects).empty());
  EXPECT_EQ(subjects.size(), 2u);
}

TEST(NatsSubscriptions, TheNewestOfEachAreKept) {
  NatsSubscriptions subjects;
  const std::uint32_t much = number_of(subjects, "much"), little = number_of(subjects, "little");
  for (int again = 0; again < 2; ++again) {
    subjects.count_all();
    for (int i = 0; i < 10; ++i) subjects.count(much);
    subjects.count(little);
    std::string kept;
    for (int i = 0; i < 10; ++i) kept += subjects.is_newest(much, 3) ? 'y' : 'n';
    EXPECT_EQ(kept, "nnnnnnnyyy");
    EXPECT_TRUE(subjects.is_newest(little, 3));
  }
  subjects.count_all();
  EXPECT_TRUE(subjects.is_newest(much, 0)) << "none was counted since";
}

}  // namespace
}  // namespace dance
