// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/replay/src/record/record_file.h>
#include <tetskin/replay/src/record/state_patch.h>

namespace tetskin::bullet_detail {
namespace {

Bytes randomBytes(std::size_t count, std::mt19937& random) {
  Bytes bytes(count);
  for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random() % 4);
  return bytes;
}

TEST(StatePatch, OfEqualStatesIsEmpty) {
  std::mt19937 random(1);
  const Bytes state = randomBytes(1000, random);
  EXPECT_TRUE(differenceOf(state, state).empty());
  EXPECT_EQ(applied({}, state), state);
}

TEST(StatePatch, BringsOneStateToTheOther) {
  std::mt19937 random(2);
  for (int k = 0; k < 500; ++k) {
    const Bytes from = randomBytes(random() % 200, random);
    Bytes to = k % 2 == 0 ? from : randomBytes(random() % 200, random);
    for (unsigned char& byte : to) {
      if (random() % 20 == 0) byte = static_cast<unsigned char>(random());
    }
    EXPECT_EQ(applied(differenceOf(from, to), from), to) << k;
  }
}

TEST(StatePatch, OfAFewBytesIsSmall) {
  std::mt19937 random(3);
  const Bytes from = randomBytes(100'000, random);
  Bytes to = from;
  for (std::size_t k = 5000; k < 5012; ++k) to[k] = 77;
  for (std::size_t k = 90'000; k < 90'012; ++k) to[k] = 77;
  EXPECT_EQ(differenceOf(from, to).size(), 2 * (12u + 12u));
  Bytes longer = from;
  longer.insert(longer.begin() + 300, {77, 78, 79});
  EXPECT_EQ(differenceOf(from, longer).size(), 12u + 3u);
}

TEST(StatePatch, ThatDoesNotFitIsRefused) {
  std::mt19937 random(4);
  const Bytes from = randomBytes(300, random), to = randomBytes(300, random);
  const Bytes difference = differenceOf(from, to);
  EXPECT_FALSE(applied(difference, randomBytes(100, random)));
  EXPECT_FALSE(applied(Bytes(difference.begin(), difference.end() - 1), from));
  int refused = 0;
  for (int k = 0; k < 2000; ++k) {  // whatever the bytes, nothing beyond them is read: sanitizers see it
    Bytes damaged = difference;
    damaged[random() % damaged.size()] = static_cast<unsigned char>(random());
    refused += !applied(damaged, from);
  }
  EXPECT_GT(refused, 50);
}

/// Lengths in a file have 32 bits. In places, each byte that differs may have a head and a gap before it.
TEST(StatePatch, OfAStateThatIsRecordableFitsIntoAFile) {
  Bytes from(26000), to = from;
  for (std::size_t k = 0; k < to.size(); k += 14) to[k] = 1;
  EXPECT_LT(differenceOf(from, to).size(), 2 * from.size());
  EXPECT_TRUE(isRecordable(0x7FFFFFFFu));
  EXPECT_FALSE(isRecordable(0x80000000u));
  EXPECT_FALSE(isRecordable(std::uint64_t{5} << 30));
}

}  // namespace
}  // namespace tetskin::bullet_detail
