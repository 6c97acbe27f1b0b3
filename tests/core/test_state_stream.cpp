// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/state/state_stream.h>

#include "support/allocation_count.h"

namespace tetskin::test {
namespace {

struct Large {
  std::array<double, 25> numbers{};
};

TEST(StateStream, GrowsAListAsItIsReadWhateverItsLengthSays) {
  std::vector<unsigned char> bytes(1000000, 1);
  const auto count = static_cast<std::uint32_t>(bytes.size() - sizeof(std::uint32_t));
  std::memcpy(bytes.data(), &count, sizeof count);
  StateStream stream(static_cast<const unsigned char*>(bytes.data()), bytes.size());
  std::vector<Large> list(3);
  const std::size_t before = allocatedBytes();
  resetPeak();
  stream.each(list, [&](Large& large) { stream.plain(large.numbers.data(), 5); });
  EXPECT_TRUE(stream.failed());
  EXPECT_LT(peakBytes() - before, 20 * bytes.size());
}

TEST(StateStream, ReadsAListThatIsLongerOrShorterThanTheOneThatIsThere) {
  for (const std::size_t now : {0u, 2u, 9u}) {
    std::vector<int> written = {3, 1, 4, 1, 5};
    unsigned char bytes[64];
    StateStream out(bytes, sizeof bytes);
    out.each(written, [&](int& n) { out(n); });
    StateStream in(static_cast<const unsigned char*>(bytes), out.count());
    std::vector<int> read(now, 7);
    in.each(read, [&](int& n) { in(n); });
    EXPECT_FALSE(in.failed());
    EXPECT_EQ(read, written);
  }
}

}  // namespace
}  // namespace tetskin::test
