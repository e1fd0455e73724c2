#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/suite.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra::bench {

constexpr const char* kNumpyPair = "decomposition, the reference's signs";
constexpr const char* kNumpy = "decomposition in plain NumPy";

/// Our decomposition and a plain NumPy transcription of it, on the same sequence with the same
/// distances. No rows, but a note, where there is no Python with NumPy.
struct NumpyComparison {
  std::vector<Row> rows;  ///< ours, then NumPy's
  std::string note;
};

/// Throws std::runtime_error where both end with different energies.
NumpyComparison compared_with_numpy(const std::string& name, const MeshSequence& sequence,
                                    int count, const std::filesystem::path& scratch,
                                    const Settings& settings);

}  // namespace mimetra::bench
