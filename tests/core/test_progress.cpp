// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/progress.h>

#include <chrono>

namespace tetskin {
namespace {

using Clock = std::chrono::steady_clock;

/// Continues until the application is asked, for some seconds at most.
void goOnUntilAsked(const std::vector<double>& told) {
  const std::size_t before = told.size();
  const auto start = Clock::now();
  for (std::size_t k = 0; told.size() == before && Clock::now() - start < std::chrono::seconds(5); ++k) {
    Progress::goOn(k);
  }
  EXPECT_EQ(told.size(), before + 1);
}

TEST(Progress, AsksInTheMiddleOfALoopWithTheFractionThatWasTold) {
  std::vector<double> told;
  const std::function<bool(double)> tell = [&](double fraction) {
    told.push_back(fraction);
    return told.size() < 4;
  };
  Progress progress(tell);
  EXPECT_TRUE(progress.reach(0.0));
  EXPECT_TRUE(progress.reach(0.5));
  for (std::size_t k = 0; k < 1000; ++k) Progress::goOn(k);  // sooner than anybody is asked again
  EXPECT_EQ(told.size(), 2u);
  goOnUntilAsked(told);
  EXPECT_FALSE(progress.cancelled());
  EXPECT_THROW(goOnUntilAsked(told), Cancellation);
  EXPECT_TRUE(progress.cancelled());
  EXPECT_EQ(told, (std::vector<double>{0.0, 0.5, 0.5, 0.5}));
}

TEST(Progress, WithinAnotherOneIsAskedInItsPlace) {
  std::vector<double> outer, inner;
  const std::function<bool(double)> tellOuter = [&](double fraction) { return outer.push_back(fraction), true; };
  const std::function<bool(double)> tellInner = [&](double fraction) { return inner.push_back(fraction), true; };
  const std::function<bool(double)> nobody;
  Progress begun(tellOuter);
  {
    Progress other(tellInner);
    goOnUntilAsked(inner);
    Progress silent(nobody);
    for (const auto start = Clock::now(); Clock::now() - start < std::chrono::milliseconds(250);) Progress::goOn(0);
  }
  EXPECT_EQ(inner.size(), 1u);
  EXPECT_TRUE(outer.empty());
  goOnUntilAsked(outer);
}

TEST(Progress, IsNotAskedByWhatItsOwnFunctionComputes) {
  int depth = 0, deepest = 0, others = 0;
  const std::function<bool(double)> tellOther = [&](double) { return ++others, false; };
  const std::function<bool(double)> tell = [&](double) {
    deepest = std::max(deepest, ++depth);
    if (depth < 3) {
      for (const auto start = Clock::now(); Clock::now() - start < std::chrono::milliseconds(250);) Progress::goOn(0);
      Progress other(tellOther);
      EXPECT_FALSE(other.reach(0.0));
    }
    return --depth, true;
  };
  Progress progress(tell);
  EXPECT_NO_THROW(EXPECT_TRUE(progress.reach(0.5)));
  EXPECT_EQ(deepest, 1);
  EXPECT_EQ(others, 1);
  for (const auto start = Clock::now(); others == 1 && Clock::now() - start < std::chrono::seconds(5);) {
    Progress::goOn(0);
  }
  EXPECT_EQ(others, 2) << "it is asked again afterwards";
}

}  // namespace
}  // namespace tetskin
