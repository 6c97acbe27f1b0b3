// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#ifndef _WIN32  // which has no such limit
#include <sys/resource.h>
#include <tetskin/core/types.h>

#include <csignal>

namespace tetskin::test {

/// The result of `write` while the size of files is limited to this many bytes. This stands in for a full disk.
template <class Write>
Status onAFullDisk(rlim_t bytes, Write&& write) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = bytes;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const Status status = write();
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  return status;
}

}  // namespace tetskin::test
#endif
