#include "core/bus/channel.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/random.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

const std::string kTypesFolder = std::string(DANCE_SOURCE_DIR) + "/lcmtypes";

GuestId guest(std::string_view text) { return GuestId::parse(text).value(); }

Channel example_of(const ChannelRow& row) {
  if (row.where == Where::kLocal) return Channel::of_house(row.signal);
  return row.where == Where::kProgram ? Channel::of_program(row.signal, "manager")
                                      : Channel::of(row.signal, row.where, guest("alice"));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

// "`POSE/capture/<guest>` | `pose_t`" of each row of the README's table of channels.
std::vector<std::string> rows_of_readme() {
  std::ifstream readme(kTypesFolder + "/README.md");
  std::vector<std::string> rows;
  for (std::string line; std::getline(readme, line);) {
    if (!line.starts_with("| `") || line.find('/') > line.find("` |")) continue;
    const std::size_t type_end = line.find("` |", line.find("| `", 3)) + 1;
    rows.push_back(line.substr(2, type_end - 2));
  }
  return rows;
}

TEST(ChannelTable, IsTheTableOfTheReadme) {
  std::vector<std::string> rows;
  for (const ChannelRow& row : kChannelTable)
    rows.push_back("`" + std::string(row.pattern) + "` | `" + std::string(row.type) + "`");
  EXPECT_EQ(rows_of_readme(), rows);
}

TEST(ChannelTable, NamesTypesThatExistAndLeavesNoneOut) {
  std::set<std::string> types, files;
  for (const ChannelRow& row : kChannelTable) types.insert(std::string(row.type));
  for (const auto& entry : std::filesystem::directory_iterator(kTypesFolder))
    if (entry.path().extension() == ".lcm") files.insert(entry.path().stem().string());
  EXPECT_EQ(types, files);
}

TEST(ChannelTable, HasPatternsThatAreTheNames) {
  for (const ChannelRow& row : kChannelTable) {
    std::string expected = replaced(std::string(row.pattern), "<guest>", "alice");
    expected = replaced(expected, "<program>", "manager");
    EXPECT_EQ(example_of(row).view(), expected);
  }
}

TEST(Channel, ComesBackFromItsNameInEveryRow) {
  for (const ChannelRow& row : kChannelTable) {
    const Channel channel = example_of(row);
    const auto parsed = Channel::parse(channel.view());
    ASSERT_TRUE(parsed.has_value()) << channel.view();
    EXPECT_EQ(parsed->signal(), row.signal);
    EXPECT_EQ(parsed->where(), row.where);
    EXPECT_TRUE(*parsed == channel);
    EXPECT_EQ(std::string(parsed->c_str()), channel.view());
    if (row.where == Where::kProgram) {
      EXPECT_EQ(parsed->program(), "manager");
      EXPECT_FALSE(parsed->guest().is_set());
    } else if (row.where == Where::kLocal) {
      EXPECT_FALSE(parsed->guest().is_set());
      EXPECT_TRUE(parsed->program().empty());
    } else {
      EXPECT_EQ(parsed->guest(), guest("alice"));
      EXPECT_TRUE(parsed->program().empty());
    }
  }
}

TEST(Channel, FitsWithTheLongestGuest) {
  const std::string longest(kMaxGuestIdLength, 'z');
  for (const ChannelRow& row : kChannelTable) {
    if (row.where == Where::kLocal) continue;
    const Channel channel = row.where == Where::kProgram
                                ? Channel::of_program(row.signal, longest)
                                : Channel::of(row.signal, row.where, guest(longest));
    EXPECT_LE(channel.view().size(), kMaxChannelLength);
    EXPECT_TRUE(Channel::parse(channel.view()).has_value());
  }
}

TEST(Channel, RefusesNamesThatAreNotOurs) {
  const std::string too_long = "POSE/capture/" + std::string(kMaxGuestIdLength + 1, 'a');
  const std::string embedded_nul("POSE/capture/al\0ce", 18);
  for (const std::string& name :
       std::vector<std::string>{"",
                                "/",
                                "//",
                                "///",
                                "POSE",
                                "POSE/",
                                "POSE/capture",
                                "POSE/capture/",
                                "POSE//alice",
                                "/capture/alice",
                                "POSE/capture/alice/",
                                "POSE/capture/alice/bob",
                                "POSE/capture/Alice",
                                "POSE/capture/al ice",
                                "POSE/capture/.*",
                                "POSE/capture/<guest>",
                                "pose/capture/alice",
                                "POSE/Capture/alice",
                                "POSE/elsewhere/alice",
                                "POSE/view/alice",
                                "POSE/program/alice",
                                "GUEST/capture/alice",
                                "MUSIC/guest/alice",
                                "AVATAR/room/alice",
                                "STAGE_TIME/stage/alice",
                                "STATS",
                                "STATS/",
                                "STATS/stage/alice",
                                "STATS/Manager",
                                "BEAT",
                                "BEAT/",
                                "BEAT/alice",
                                "BEAT/local/",
                                "BEAT/local/alice",
                                "POSE/local",
                                "POSE/local/alice",
                                " POSE/capture/alice",
                                "POSE/capture/alice\n",
                                "LCM_TEST",
                                too_long,
                                embedded_nul,
                                std::string(1000, '/'),
                                std::string(64, 'A'),
                                "POSE/capture/" + std::string(100'000, 'a')}) {
    EXPECT_FALSE(Channel::parse(name).has_value()) << name.substr(0, 80);
  }
}

TEST(Channel, TakesNoNameThatItWouldNotBuild) {
  // Every single change of a byte either is refused, or is another name of ours that comes back the
  // same.
  int taken = 0;
  for (const ChannelRow& row : kChannelTable) {
    const std::string original(example_of(row).view());
    for (std::size_t at = 0; at < original.size(); ++at) {
      for (int byte = 0; byte < 256; ++byte) {
        std::string name = original;
        name[at] = static_cast<char>(byte);
        const auto parsed = Channel::parse(name);
        if (!parsed) continue;
        ++taken;
        EXPECT_EQ(parsed->view(), name);
      }
    }
  }
  EXPECT_GT(taken, 0);  // alice may become blice
}

TEST(Channel, RefusesNoise) {
  Random random(51);
  const std::string_view alphabet = "POSE/capturegstviewHANDSKLT_<>.*-0";
  for (int i = 0; i < 100'000; ++i) {
    std::string name;
    for (std::uint64_t size = random.below(80); name.size() < size;)
      name += alphabet[random.below(alphabet.size())];
    const auto parsed = Channel::parse(name);
    if (parsed) {
      EXPECT_EQ(parsed->view(), name);
    }
  }
}

TEST(Channel, AllocatesNothing) {
  const GuestId alice = guest("alice");
  const AllocationGuard guard;
  const Channel built = Channel::of(Signal::kPose, Where::kStage, alice);
  const auto parsed = Channel::parse("POSE/stage/alice");
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_TRUE(parsed.has_value() && *parsed == built);
}

TEST(Where, IsFoundByItsName) {
  for (const Where where :
       {Where::kCapture, Where::kGuest, Where::kStage, Where::kView, Where::kRoom})
    EXPECT_EQ(find_where(where_name(where)), where);
  EXPECT_FALSE(find_where(""));
  EXPECT_FALSE(find_where("program"));
  EXPECT_FALSE(find_where("local"));
}

TEST(ChannelDeathTest, DiesOnAGuestThatIsNotSet) {
  EXPECT_DEATH(Channel::of(Signal::kPose, Where::kStage, GuestId()), "is_set");
  EXPECT_DEATH(Channel::of_program(Signal::kStats, "Not A Name"), "assertion failed");
}

}  // namespace
}  // namespace dance
