#include "tests/field_mutation.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <string>

namespace dance {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Bytes glb_of(std::string json) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    std::string text(4, '\0');
    std::memcpy(text.data(), &number, 4);
    return text;
  };
  const std::string binary = "12345678";
  return bytes_of("glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) +
                  "JSON" + json + word(binary.size()) + std::string("BIN\0", 4) + binary);
}

TEST(FieldMutation, ChangesNumbersOfTextAndKeepsTheRest) {
  const std::string text = "{\"offset\": 40, \"size\": [1, -2.5]}";
  Random random(1);
  std::set<std::string> seen;
  int with_syntax = 0;
  for (int i = 0; i < 1000; ++i) {
    const Bytes mutated = with_field_mutated(bytes_of(text), random);
    const std::string now(mutated.begin(), mutated.end());
    seen.insert(now);
    with_syntax += now.find("{\"offset\": ") == 0 && now.find(", \"size\": [") != std::string::npos;
  }
  EXPECT_GT(seen.size(), 40u);
  EXPECT_GT(with_syntax, 600);
  EXPECT_TRUE(seen.count("{\"offset\": 4294967296, \"size\": [1, -2.5]}"));
}

TEST(FieldMutation, KeepsTheLengthsOfAGlbConsistent) {
  const Bytes glb = glb_of("{\"bufferViews\":[{\"byteOffset\":4,\"byteLength\":8}]}");
  Random random(2);
  int consistent = 0;
  for (int i = 0; i < 1000; ++i) {
    const Bytes mutated = with_field_mutated(glb, random);
    std::uint32_t total = 0, json = 0;
    std::memcpy(&total, mutated.data() + 8, 4);
    std::memcpy(&json, mutated.data() + 12, 4);
    consistent += total == mutated.size() && json % 4 == 0 && json < mutated.size() - 30 &&
                  std::memcmp(mutated.data() + 20 + json + 4, "BIN", 3) == 0;
  }
  EXPECT_GT(consistent, 600);
}

TEST(FieldMutation, AcceptsAnyInput) {
  Random random(3);
  EXPECT_TRUE(with_field_mutated({}, random).empty());
  for (int i = 0; i < 500; ++i) {
    Bytes noise(random.below(40));
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random.next_u64());
    if (i % 2 == 0 && noise.size() > 20) std::memcpy(noise.data(), "glTF", 4);
    with_field_mutated(noise, random);
  }
}

}  // namespace
}  // namespace dance
