// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/printed_table.h"

#include <nlohmann/json.hpp>

namespace tetskin {
namespace {

using scenes::PrintedTable;

TEST(PrintedTable, AlignsNamesToTheLeftAndNumbersToTheRight) {
  PrintedTable table({{"phase", ""}, {"to", "s"}, {"simulation", "ms/frame"}});
  table.add({"lies", "0.25", "3.1"});
  table.add({"is swung about", "10.00", "-"});
  EXPECT_EQ(table.text(),
            "  phase              to  simulation\n"
            "                      s    ms/frame\n"
            "  lies             0.25         3.1\n"
            "  is swung about  10.00           -\n");
}

TEST(PrintedTable, NumbersAreFormattedAsTheSummaryHasThem) {
  nlohmann::ordered_json json;
  json["speed"] = 0.1234;
  json["steps"] = 12;
  EXPECT_EQ(scenes::formatted("%.2f m/s", json, "speed"), "0.12 m/s");
  EXPECT_EQ(scenes::formatted("%.0f", json, "steps"), "12");
}

}  // namespace
}  // namespace tetskin
