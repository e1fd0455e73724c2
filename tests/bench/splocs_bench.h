#pragma once

#include <optional>
#include <vector>

#include "tests/bench/subjects.h"
#include "tests/bench/suite.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra::bench {

constexpr const char* kDecomposition = "decomposition without geodesics";
constexpr const char* kStart = "decomposition start";
constexpr const char* kWeightStep = "weight step";
constexpr const char* kAdmm = "ADMM, 10 steps";

/// Of each decomposition that is timed.
constexpr int kIterations = DecompositionOptions::kReferenceIterations;

/// The decomposition that is timed: K components, kIterations, distances known in advance.
/// Distances are computed here, by a first run.
DecompositionOptions prepared_options(const MeshSequence& sequence, int count);

/// Products of the start, kIterations of 10 ADMM steps, and what keeps them going.
Work decomposition_work(double frames, double vertices, double count, const Machine& machine);

Row decomposition_row(const std::string& name, const MeshSequence& sequence, int count,
                      const Settings& settings);

/// Start, weight step and ADMM on their own.
std::vector<Case> splocs_kernel_cases(const std::string& name, const MeshSequence& sequence,
                                      int count, const Settings& settings);
std::vector<Row> splocs_kernel_rows(const std::string& name, const MeshSequence& sequence,
                                    int count, const Settings& settings);

}  // namespace mimetra::bench
