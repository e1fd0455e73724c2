#pragma once

#include <filesystem>
#include <vector>

#include "tests/bench/subjects.h"
#include "tests/bench/suite.h"

namespace mimetra::bench {

/// `mimetra transfer` from .npy to PLY, kIterations of its decomposition, with regions as PVD: the
/// whole, and where its time goes by its manifest.
std::vector<Row> transfer_command_rows(const Subject& subject, int count,
                                       const std::filesystem::path& mimetra,
                                       const std::filesystem::path& scratch,
                                       const Settings& settings);

/// `mimetra decompose` from .npy, kIterations.
Row decompose_command_row(const Subject& subject, int count, const std::filesystem::path& mimetra,
                          const std::filesystem::path& scratch, const Settings& settings);

}  // namespace mimetra::bench
