// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The programs' command lines: options of the same kind are checked and spelled alike everywhere. Only the source file
// includes the library that parses them, which takes seconds to compile.
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

/// Where and how results are written.
struct OutputOptions {
  std::string out;   ///< folder of the frames
  std::string json;  ///< file of the summary; empty: summary.json in the folder
  int frames = 0;
  int every = 1;  ///< write every n-th frame as OBJ and PC2
  bool quiet = false;
  std::string view = {};          ///< file of a page that plays the run; empty: none, unless there is one by default
  bool viewByDefault = false;     ///< by default view.html in the folder, where a page can be made
  bool noView = false;            ///< no page by default either
  bool hash = false;              ///< print a hash of the nodes of all frames
  bool checkDeterminism = false;  ///< make each step twice from a snapshot, and compare
  std::string record = {};        ///< file to write the run to
  std::string replay = {};        ///< file of a run to play
  std::string program = {};       ///< the demo's name, and its arguments without the files of a run
  std::vector<std::string> arguments = {};
  std::vector<std::string> formats = {};  ///< "obj", "glb", "pc2"; empty: see `formatsOf`
};

/// A whole command line, and a description of what it does.
struct Example {
  std::string line;
  std::string does;
};

/// The end of a program's --help.
struct HelpEnd {
  std::vector<Example> examples;
  std::string failure;  ///< meaning of exit status 1; empty: the program never returns it
};

/// Options and the variables that they set. A variable keeps its value if its option is not given, and must outlive
/// this object. An invalid value is refused in one line.
class CommandLine {
 public:
  enum class Need { Optional, Required };

  /// Has --help and --version. If an option is given twice, the last one counts; a list takes both.
  CommandLine(const std::string& description, const HelpEnd& end);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  // `text` describes the option in --help. A shared option (see shared_options.h) already has a description: there,
  // `text` is a note on what this program does with it, shown in parentheses, or empty.

  void addFlag(const std::string& name, bool& value, const std::string& text = "");
  void addText(const std::string& name, std::string& value, const std::string& text = "");
  // Names of files and folders must not be empty. All are checked before the demo runs: see NamedFiles. `preset`
  // describes the default if the value itself does not.

  /// A file to be read.
  void addInput(const std::string& name, std::string& value, const std::string& text = "", Need need = Need::Optional,
                const std::string& preset = "");
  /// Files to be read, in this order: as many as follow the option.
  void addInputs(const std::string& name, std::vector<std::string>& values, const std::string& text, Need need);
  /// A file to be written.
  /// extensions  permitted ones, with their dots; empty: any
  void addOutput(const std::string& name, std::string& value, const std::string& text = "", Need need = Need::Optional,
                 const std::vector<std::string>& extensions = {}, const std::string& preset = "");
  /// A folder in which files with certain names are written.
  void addFolder(const std::string& name, std::string& value, const std::string& text,
                 const NamedFiles::IsWritten& isWritten);
  /// A whole number from 1 to `maximum`.
  void addCount(const std::string& name, int& value, const std::string& text = "",
                int maximum = std::numeric_limits<int>::max(), const std::string& preset = "");
  void addCount(const std::string& name, std::size_t& value, const std::string& text = "",
                int maximum = std::numeric_limits<int>::max());
  /// A finite number above 0.
  void addPositive(const std::string& name, double& value, const std::string& text, const std::string& preset = "");
  /// One of several words.
  void addWord(const std::string& name, std::string& value, const std::vector<std::string>& known,
               const std::string& text = "");
  /// A list separated by commas.
  void addWords(const std::string& name, std::vector<std::string>& values, const std::string& text,
                const std::string& preset = "");
  void addCounts(const std::string& name, std::vector<std::size_t>& values, const std::string& text);

  // Shared options that belong together.

  /// Adds --mesh, or --model and --triangles.
  void addSurfaceOptions(ModelOptions& options);
  /// Adds the options of a surface, --tets, --no-duplicate-elements and --calibrate.
  void addMeshOptions(ModelOptions& options);
  /// Adds the options of a mesh and its cage, and --cage, which replaces --tets.
  void addModelOptions(ModelOptions& options);
  /// Adds --elasticity: tetskin or bullet.
  void addElasticityOption(Force& force, const std::string& text);
  void addContactOption(Contact& contact);
  /// Adds --self-contact: auto, on or off.
  void addSelfContactOption(SelfContactWish& wish);
  /// Adds --interpolation.
  void addInterpolationOption(SkinOptions& options);
  /// Adds --normals, --outside, --max-distance.
  void addSkinOptions(SkinOptions& options);
  /// Adds --json.
  void addSummaryOption(std::string& path, const std::string& preset = "");
  /// Adds --quiet.
  void addQuietOption(bool& quiet);
  /// Adds --frames, --out, --format, --every, --view, --json, --hash, --check-determinism, --record, --replay, --quiet;
  /// --no-view where there is a page by default. The defaults of `options` are the demo's.
  void addOutputOptions(OutputOptions& options);

  /// True if an option was on the parsed command line.
  bool given(const std::string& name) const;
  /// Parses the command line, and runs the demo unless help or the version was asked for; turns errors into one line on
  /// standard error and an exit status.
  int run(int argc, char** argv, const std::function<int()>& demo);

 private:
  struct Parser;
  void addName(const std::string& name, std::string& value, const std::string& text, Need need, const char* label,
               const std::string& preset);
  /// tell  called once the command line is parsed
  void addFiles(const std::function<void(NamedFiles& files)>& tell);

  std::unique_ptr<Parser> parser_;
};

/// The file to which the summary is written.
std::string summaryPath(const OutputOptions& options);

}  // namespace tetskin::scenes
