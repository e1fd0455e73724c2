#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/bench/machine.h"

namespace mimetra::bench {

/// Whose size a time belongs to; 0 where something plays no part.
struct Size {
  std::string subject;
  int frames = 0;
  int vertices = 0;
  std::string count_name = {};  ///< "K", "D", "sources"
  int count = 0;

  std::string text() const;
};

/// What is shown beside a time: a share of it for each of `pieces`, or the rate of `bytes`.
struct Rate {
  std::string piece = {};
  double pieces = 0;
  double bytes = 0;
};

/// What is measured, and what came out.
struct Row {
  std::string group;
  std::string what;
  Size size;
  Work work;
  Rate rate = {};
  std::vector<double> seconds = {};  ///< of each repetition
  double peak_bytes = 0;             ///< of a whole command; 0 where it was not measured
  std::string note = {};

  double median() const;
};

/// One kernel.
struct Case {
  Row row;
  std::function<void()> run;
};

/// Times kernels with Google Benchmark, in the order given.
std::vector<Row> measured(const std::vector<Case>& cases, bool quick);

/// Size of all files below a folder.
double bytes_below(const std::filesystem::path& folder);

/// Runs of what is too long for Google Benchmark to repeat on its own.
constexpr int kRepetitions = 5;

struct Settings {
  bool quick = false;
  Machine machine;
};

}  // namespace mimetra::bench
