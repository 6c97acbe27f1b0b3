// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The programs' command lines: options of the same kind are checked and spelled alike everywhere. Only the source file
// knows the library that parses them, which takes seconds to compile.
#pragma once

#include <tetskin/core/mesh_skin.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "scenes/model.h"
#include "scenes/named_files.h"
#include "scenes/self_contact.h"
#include "scenes/world.h"

namespace tetskin::scenes {

/// Exit statuses of every demo.
constexpr int kDone = 0, kRunFailed = 1, kBadInput = 2;

/// Where the results go.
struct OutputOptions {
  std::string out;   ///< folder of the OBJ sequence
  std::string json;  ///< file of the summary; empty: summary.json in the folder
  int frames = 0;
  int every = 1;  ///< write every so many frames
  bool quiet = false;
  std::string view = {};       ///< file of a page that plays the run; empty: none, unless by default
  bool viewByDefault = false;  ///< view.html in the folder, where a page can be made
  bool noView = false;         ///< none by default either
  bool hash = false;           ///< print what the nodes of all frames hash to
};

/// A whole command line, and what it does.
struct Example {
  std::string line;
  std::string does;
};

/// How a program's --help ends.
struct HelpEnd {
  std::vector<Example> examples;
  std::string failure;  ///< what exit status 1 means; empty: there is none
};

/// Options and what they set, which keeps its value where one is not given, and must outlive this object. What a value
/// may not be is refused in one line.
class CommandLine {
 public:
  enum class Need { Optional, Required };

  /// With --help and --version. Of an option given twice the last counts; a list takes both.
  CommandLine(const std::string& description, const HelpEnd& end);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  void addFlag(const std::string& name, bool& value, const std::string& description);
  void addText(const std::string& name, std::string& value, const std::string& description);
  // Names of files and folders, not empty. All are looked at before the demo runs: see NamedFiles.

  /// A file to be read.
  void addInput(const std::string& name, std::string& value, const std::string& description,
                Need need = Need::Optional);
  /// A file to be written. extensions  that it may have, with their dots; none: any
  void addOutput(const std::string& name, std::string& value, const std::string& description,
                 Need need = Need::Optional, const std::vector<std::string>& extensions = {});
  /// A folder in which files of some names are written.
  void addFolder(const std::string& name, std::string& value, const std::string& description,
                 const NamedFiles::IsWritten& isWritten);
  /// A whole number from 1 to `most`.
  void addCount(const std::string& name, int& value, const std::string& description,
                int most = std::numeric_limits<int>::max());
  void addCount(const std::string& name, std::size_t& value, const std::string& description,
                int most = std::numeric_limits<int>::max());
  /// Finite, above 0.
  void addPositive(const std::string& name, double& value, const std::string& description);
  /// One of some words.
  void addWord(const std::string& name, std::string& value, const std::vector<std::string>& known,
               const std::string& description);
  /// Lists, with commas.
  void addWords(const std::string& name, std::vector<std::string>& values, const std::string& description);
  void addCounts(const std::string& name, std::vector<std::size_t>& values, const std::string& description);

  // What several programs have.

  /// --mesh, or --model and --triangles.
  void addSurfaceOptions(ModelOptions& options);
  /// Those and --tets.
  void addMeshOptions(ModelOptions& options);
  /// Those and --cage, instead of --tets.
  void addModelOptions(ModelOptions& options);
  /// --force: bullet (neo-Hookean) or tetskin.
  void addForceOption(Force& force);
  void addContactOption(Contact& contact);
  /// --self-contact: on or off.
  void addSelfContactOption(SelfContactWish& wish);
  /// --interpolation.
  void addInterpolationOption(SkinOptions& options);
  /// --normals, --outside, --max-distance.
  void addSkinOptions(SkinOptions& options);
  /// --json.
  void addSummaryOption(std::string& path, const std::string& description);
  /// --quiet.
  void addQuietOption(bool& quiet);
  /// --frames, --every, --out, --view, --hash, --json, --quiet; --no-view where there is a view by default. The
  /// defaults of `options` are the demo's.
  void addOutputOptions(OutputOptions& options);

  /// Whether an option was on the line that was parsed.
  bool given(const std::string& name) const;
  /// Parses the line, and runs the demo unless that asks for help or the version; turns errors into one line on
  /// standard error and an exit status.
  int run(int argc, char** argv, const std::function<int()>& demo);

 private:
  struct Parser;
  void addName(const std::string& name, std::string& value, const std::string& description, Need need);
  /// Told once the line is parsed.
  void addFiles(const std::function<void(NamedFiles& files)>& tell);

  std::unique_ptr<Parser> parser_;
};

/// Where the summary goes.
std::string summaryPath(const OutputOptions& options);

}  // namespace tetskin::scenes
