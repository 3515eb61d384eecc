#include "tartan_calib/target/tag_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>

#include "tartan_calib/error.h"

namespace tartan_calib::target {
namespace {

/// The code as read from the tag after a quarter turn.
std::uint64_t turned(std::uint64_t code, int cells) {
  std::uint64_t result = 0;
  for (int row = 0; row < cells; ++row) {
    for (int col = 0; col < cells; ++col) {
      const int from = col * cells + cells - 1 - row;
      const std::uint64_t white = (code >> static_cast<unsigned>(cells * cells - 1 - from)) & 1U;
      result |= white << static_cast<unsigned>(cells * cells - 1 - (row * cells + col));
    }
  }
  return result;
}

int hammingDistance(std::uint64_t a, std::uint64_t b) { return static_cast<int>(std::bitset<64>(a ^ b).count()); }

struct Expected {
  std::string name;
  int payload_cells;
  int min_distance;
  std::size_t num_codes;
};

class TagFamilyTest : public testing::TestWithParam<Expected> {};

TEST_P(TagFamilyTest, hasThePublishedSize) {
  const TagFamily family = tagFamily(GetParam().name);
  EXPECT_EQ(family.name, GetParam().name);
  EXPECT_EQ(family.payload_cells, GetParam().payload_cells);
  EXPECT_EQ(family.min_hamming_distance, GetParam().min_distance);
  EXPECT_EQ(family.codes.size(), GetParam().num_codes);
}

TEST_P(TagFamilyTest, keepsItsDistanceInAllTurns) {
  const TagFamily family = tagFamily(GetParam().name);
  int least = 64;
  for (std::size_t i = 0; i < family.codes.size(); ++i) {
    std::uint64_t code = family.codes[i];
    for (int quarter_turns = 0; quarter_turns < 4; ++quarter_turns) {
      for (std::size_t j = quarter_turns == 0 ? i + 1 : i; j < family.codes.size(); ++j) {
        least = std::min(least, hammingDistance(code, family.codes[j]));
      }
      code = turned(code, family.payload_cells);
    }
    ASSERT_EQ(code, family.codes[i]);
  }
  EXPECT_GE(least, family.min_hamming_distance);
}

INSTANTIATE_TEST_SUITE_P(, TagFamilyTest,
                         testing::Values(Expected{"t16h5", 4, 5, 30}, Expected{"t25h9", 5, 9, 35},
                                         Expected{"t36h10", 6, 10, 2320}, Expected{"t36h11", 6, 11, 587}),
                         [](const auto& family) { return family.param.name; });

TEST(TagFamily, hasKalibrsCodes) {
  // Kalibr's table of the family, bits row by row from the top left.
  const TagFamily family = tagFamily("t36h11");
  EXPECT_EQ(family.codes[0], 0xd5d628584U);
  EXPECT_EQ(family.codes[1], 0xd97f18b49U);
  EXPECT_EQ(family.codes[2], 0xdd280910eU);
  EXPECT_EQ(family.codes[586], 0xe83be4b73U);
}

TEST(TagFamily, paintsIdZeroAsPrinted) {
  const TagFamily family = tagFamily("t36h11");
  const std::vector<std::string> printed = {"110101", "011101", "011000", "101000", "010110", "000100"};
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) {
      EXPECT_EQ(isWhiteCell(family, 0, row, col),
                printed[static_cast<std::size_t>(row)][static_cast<std::size_t>(col)] == '1')
          << row << " " << col;
    }
  }
}

TEST(TagFamily, ofAnUnknownNameIsAnErrorThatListsTheKnownOnes) {
  try {
    tagFamily("36h11");
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("36h11"), std::string::npos);
    for (const std::string& name : tagFamilyNames()) {
      EXPECT_NE(message.find(name), std::string::npos) << name;
    }
  }
}

}  // namespace
}  // namespace tartan_calib::target
