#include "tunnel/cluster/cluster_bundle.h"

#include <gtest/gtest.h>

#include "tests/tunnel/cluster/cluster_samples.h"

namespace dance {
namespace {

std::vector<std::vector<std::uint8_t>> parts_of(cluster::Bytes bytes, bool& is_good) {
  std::vector<std::vector<std::uint8_t>> parts;
  cluster::BundleReader reader(bytes);
  while (const auto part = reader.next()) parts.emplace_back(part->begin(), part->end());
  is_good = reader.is_good();
  return parts;
}

TEST(ClusterBundle, GivesBackWhatWasAddedInOrder) {
  cluster::BundleWriter bundle;
  std::vector<std::vector<std::uint8_t>> added;
  for (const cluster::Message& message : cluster_samples::messages()) {
    ASSERT_TRUE(bundle.try_add(message));
    added.push_back(cluster_samples::bytes_of(message));
  }
  bool is_good = false;
  EXPECT_EQ(parts_of(bundle.bytes(), is_good), added);
  EXPECT_TRUE(is_good);
  bundle.clear();
  EXPECT_TRUE(bundle.is_empty());
}

TEST(ClusterBundle, OneMessageGoesAsItIs) {
  cluster::BundleWriter bundle;
  const cluster::Message message = cluster::ClockQuestion{6, 7};
  ASSERT_TRUE(bundle.try_add(message));
  EXPECT_TRUE(std::ranges::equal(bundle.bytes(), cluster_samples::bytes_of(message)));
  bool is_good = false;
  EXPECT_EQ(parts_of(bundle.bytes(), is_good).size(), 1u);
  EXPECT_TRUE(is_good);
}

TEST(ClusterBundle, IsBounded) {
  cluster::BundleWriter bundle;
  std::size_t count = 0;
  while (bundle.try_add(cluster::Message(cluster_samples::record()))) ++count;
  EXPECT_GT(count, 50u);
  EXPECT_LE(bundle.bytes().size(), cluster::kMaxBundle);
  bool is_good = false;
  EXPECT_EQ(parts_of(bundle.bytes(), is_good).size(), count);
}

// Each prefix, and each byte changed: no part is beyond the bytes, and what is wrong is said.
TEST(ClusterBundle, TakesNothingThatIsNone) {
  cluster::BundleWriter bundle;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(bundle.try_add(cluster::ClockQuestion{6, 7}));
  const std::vector<std::uint8_t> whole(bundle.bytes().begin(), bundle.bytes().end());
  bool is_good = true;
  std::size_t whole_prefixes = 0;
  for (std::size_t size = 2; size < whole.size(); ++size) {
    const auto parts = parts_of(cluster::Bytes(whole).first(size), is_good);
    EXPECT_LT(parts.size(), 3u);
    whole_prefixes += is_good ? 1 : 0;
  }
  EXPECT_EQ(whole_prefixes, 2u) << "which end where a part does";
  // None within another.
  std::vector<std::uint8_t> nested{whole[0], whole[1]};
  nested.push_back(static_cast<std::uint8_t>(whole.size()));
  nested.push_back(0);
  nested.insert(nested.end(), whole.begin(), whole.end());
  EXPECT_TRUE(parts_of(nested, is_good).empty());
  EXPECT_FALSE(is_good);
}

}  // namespace
}  // namespace dance
