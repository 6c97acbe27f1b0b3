// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Stands in for libFuzzer, with the options that the tests use: -max_total_time=SECONDS, and folders of seeds. Runs
// every seed, and then seeds changed at random until the time is over. The last input is in the file crash_input.
#include "fuzz.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

namespace {

using Input = std::vector<std::uint8_t>;

constexpr std::size_t kMaxInput = 4096;
Input tried;  // for the signal handler

void keepInput(int signal) {
  std::ofstream("crash_input", std::ios::binary).write(reinterpret_cast<const char*>(tried.data()), tried.size());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<Input> readSeeds(const std::vector<std::string>& folders) {
  std::vector<Input> seeds;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::ifstream file(entry.path(), std::ios::binary);
      seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
  }
  return seeds;
}

/// Replaces, inserts or removes some bytes, up to a few times.
void mutate(Input& input, std::mt19937& random) {
  for (std::size_t change = 1 + random() % 4; change > 0; --change) {
    const std::size_t at = input.empty() ? 0 : random() % input.size();
    const auto value = static_cast<std::uint8_t>(random());
    const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random() % 3) {
      case 0:
        if (!input.empty()) *place = value;
        break;
      case 1:
        input.insert(place, 1 + random() % 4, value);
        break;
      default:
        input.erase(place, place + static_cast<std::ptrdiff_t>(std::min<std::size_t>(input.size() - at, random() % 8)));
    }
  }
  if (input.size() > kMaxInput) input.resize(kMaxInput);
}

void run(const Input& input) {
  tried = input;
  LLVMFuzzerTestOneInput(tried.data(), tried.size());
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kTime = "-max_total_time=";
  double seconds = 1.0;
  std::vector<std::string> folders;
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument.rfind(kTime, 0) == 0) {
      seconds = std::stod(argument.substr(kTime.size()));
    } else if (argument[0] != '-') {
      folders.push_back(argument);
    }
  }
  std::signal(SIGABRT, keepInput);
  std::signal(SIGSEGV, keepInput);
  std::vector<Input> seeds = readSeeds(folders);
  for (const Input& seed : seeds) run(seed);
  // Without seeds: random bytes of all lengths.
  std::mt19937 random(1);
  for (std::size_t length = 16; seeds.size() < 8; length *= 2) {
    seeds.emplace_back(length);
    for (std::uint8_t& byte : seeds.back()) byte = static_cast<std::uint8_t>(random());
  }
  using Clock = std::chrono::steady_clock;
  std::size_t runs = 0;
  for (const auto start = Clock::now(); std::chrono::duration<double>(Clock::now() - start).count() < seconds; ++runs) {
    Input input = seeds[random() % seeds.size()];
    mutate(input, random);
    run(input);
  }
  std::printf("%zu inputs of %zu seeds\n", runs, seeds.size());
  return 0;
}
