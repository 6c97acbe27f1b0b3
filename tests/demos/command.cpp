// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "command.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

namespace tetskin::test {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace

CommandFolder::CommandFolder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  folder_ = std::filesystem::temp_directory_path() /
            ("tetskin_" + std::string(test->test_suite_name()) + "_" + test->name() + "_" + std::to_string(getpid()));
  std::filesystem::remove_all(folder_);
  std::filesystem::create_directories(folder_);
}

CommandFolder::~CommandFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string CommandFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name) << text;
  return path(name);
}

std::string CommandFolder::read(const std::string& name) const {
  std::ostringstream text;
  text << std::ifstream(folder_ / name).rdbuf();
  return text.str();
}

std::size_t CommandFolder::count(const std::string& subfolder, const std::string& extension) const {
  std::size_t n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / subfolder))
    n += entry.path().extension() == extension;
  return n;
}

CommandResult CommandFolder::run(const std::string& executable, const std::vector<std::string>& arguments) const {
  std::string command = "cd " + quoted(folder_.string()) + " && " + quoted(executable);
  for (const std::string& a : arguments) command += " " + quoted(a);
  command += " >.stdout 2>.stderr </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(".stdout"), read(".stderr")};
}

std::map<std::string, nlohmann::json> figuresOf(const nlohmann::json& scene) {
  std::map<std::string, nlohmann::json> figures;
  for (const auto& figure : scene["figures"]) figures[figure["name"]] = figure;
  return figures;
}

std::vector<std::array<double, 3>> objPositions(const std::string& text) {
  std::vector<std::array<double, 3>> positions;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("v ", 0) != 0) continue;
    std::istringstream numbers(line.substr(2));
    auto& p = positions.emplace_back();
    numbers >> p[0] >> p[1] >> p[2];
  }
  return positions;
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

void expectRefused(const CommandResult& result, const std::string& word) {
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
}

}  // namespace tetskin::test
