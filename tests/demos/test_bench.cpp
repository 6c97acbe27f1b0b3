// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include <map>

#include "command.h"

namespace tetskin {
namespace {

/// A case whose skins are not those that are due ends with an error.
TEST(Bench, UpdatesTheSkinsOfACrowdThatAreDueAndNoOthers) {
  const test::CommandFolder folder;
  const test::CommandResult result =
      folder.run(TETSKIN_BENCH, {"--bodies", "40", "--triangles", "4000", "--benchmark_filter=^Crowd/",
                                 "--benchmark_out=c.json", "--benchmark_out_format=json"});
  ASSERT_EQ(result.status, 0) << result.err;
  std::map<std::string, double> updates, bytes;
  const auto json = folder.json("c.json");
  for (const auto& row : json.at("benchmarks")) {
    const auto name = row.at("name").get<std::string>();
    EXPECT_FALSE(row.contains("error_occurred")) << row;
    updates[name.substr(0, name.find("/iterations"))] = row.value("updates", -1.0);
    bytes[name.substr(0, name.find("/iterations"))] = row.value("bytes", -1.0);
  }
  EXPECT_EQ(updates.size(), 13u);
  EXPECT_EQ(updates.at("Crowd/all/every_substep"), 160.0);
  EXPECT_EQ(updates.at("Crowd/all/once_per_frame"), 40.0);
  EXPECT_EQ(updates.at("Crowd/all/asleep"), 4.0);
  EXPECT_EQ(updates.at("Crowd/all/hidden"), 4.0);
  EXPECT_EQ(updates.at("Crowd/all/no_substep"), 0.0);
  EXPECT_EQ(updates.at("Crowd/awake"), 4.0);
  if (bytes.at("Crowd/awake") > 0.0) {
    EXPECT_LT(2.0 * bytes.at("Crowd/all/once_per_frame"), bytes.at("Crowd/all/binding_each"));
  }
}

}  // namespace
}  // namespace tetskin
