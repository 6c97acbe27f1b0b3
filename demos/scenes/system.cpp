// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/system.h"

#include <algorithm>
#include <cassert>
#include <cerrno>

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#include <process.h>
#else
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tetskin::scenes {
namespace {

/// The arguments as C wants them: the last one is null.
std::vector<char*> argumentsOf(const std::vector<std::string>& command) {
  std::vector<char*> arguments(command.size() + 1);
  std::transform(command.begin(), command.end(), arguments.begin(),
                 [](const std::string& word) { return const_cast<char*>(word.c_str()); });
  return arguments;
}

}  // namespace

std::size_t heapBytes() {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

std::size_t lastLevelCacheBytes() {
#ifdef _SC_LEVEL3_CACHE_SIZE
  if (const long bytes = sysconf(_SC_LEVEL3_CACHE_SIZE); bytes > 0) return static_cast<std::size_t>(bytes);
#endif
  return 0;
}

#ifdef _WIN32

bool isTerminal(std::FILE* stream) {
  return _isatty(_fileno(stream)) != 0;
}

/// Windows decides by lists of rights: whether a file can be made shows when it is made.
bool mayWriteInto(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::is_directory(folder, error);
}

int runCommand(const std::vector<std::string>& command, bool silent) {
  assert(!command.empty());
  int kept[2] = {-1, -1};
  const int nowhere = silent ? _open("NUL", _O_WRONLY) : -1;
  for (const int stream : {1, 2}) {
    if (nowhere < 0) continue;
    kept[stream - 1] = _dup(stream);
    _dup2(nowhere, stream);
  }
  const std::vector<char*> arguments = argumentsOf(command);
  const auto status = _spawnvp(_P_WAIT, arguments[0], arguments.data());
  for (const int stream : {1, 2}) {
    if (kept[stream - 1] < 0) continue;
    _dup2(kept[stream - 1], stream);
    _close(kept[stream - 1]);
  }
  if (nowhere >= 0) _close(nowhere);
  return static_cast<int>(status);
}

#else

bool isTerminal(std::FILE* stream) {
  return isatty(fileno(stream)) != 0;
}

bool mayWriteInto(const std::filesystem::path& folder) {
  return access(folder.c_str(), W_OK | X_OK) == 0;
}

int runCommand(const std::vector<std::string>& command, bool silent) {
  assert(!command.empty());
  std::vector<char*> arguments = argumentsOf(command);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {1, 2}) {
    if (silent) posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  }
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0) return -1;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

#endif

}  // namespace tetskin::scenes
