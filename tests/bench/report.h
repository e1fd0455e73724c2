#pragma once

#include <string>
#include <vector>

#include "tests/bench/growth.h"
#include "tests/bench/suite.h"

namespace mimetra::bench {

/// Two rows of one run for the same job.
struct Comparison {
  std::string text;
  double ratio = 0;  ///< the other's time over ours
};

/// What one run of the benchmarks gave.
struct Results {
  Settings settings;
  Limits at_start, at_end;
  std::vector<Row> rows;
  std::vector<Growth> growths;
  std::vector<Comparison> comparisons;
  std::vector<std::string> notes;

  /// What floors are computed by.
  Limits limits() const { return best_of(at_start, at_end); }
};

/// Times of `other` over those of `own`, for each size that both have.
std::vector<Comparison> compared(const std::vector<Row>& rows, const std::string& own,
                                 const std::string& other);

/// For people.
std::string table_of(const Results& results);

/// For programs: the machine, its limits, every row with each repetition, growths, comparisons.
std::string json_of(const Results& results);

}  // namespace mimetra::bench
