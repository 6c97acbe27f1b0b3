// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs the demo executables as a user would.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tetskin::test {

struct CommandResult {
  int status = -1;  ///< exit status; -1 if killed by a signal
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

/// A folder for the running test, removed with this object.
class CommandFolder {
 public:
  CommandFolder();
  ~CommandFolder();
  CommandFolder(const CommandFolder&) = delete;
  CommandFolder& operator=(const CommandFolder&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(read(name)); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::size_t count(const std::string& subfolder, const std::string& extension) const;

  CommandResult run(const std::string& executable, const std::vector<std::string>& arguments) const;

 private:
  std::filesystem::path folder_;
};

/// The arguments of a command line.
std::vector<std::string> words(const std::string& line);

/// Expects exit status 2 and one line that names what is wrong.
void expectRefused(const CommandResult& result, const std::string& word);

/// The figures of a measured scene, by name.
std::map<std::string, nlohmann::json> figuresOf(const nlohmann::json& scene);

/// Vertex positions of an OBJ file.
std::vector<std::array<double, 3>> objPositions(const std::string& text);

}  // namespace tetskin::test
