#pragma once

#include <filesystem>
#include <vector>

#include "tests/bench/subjects.h"
#include "tests/bench/suite.h"

namespace mimetra::bench {

/// The performance written and read as OBJ and PLY files and as one array, in `scratch`.
std::vector<Row> io_rows(const Subject& subject, const std::filesystem::path& scratch,
                         const Settings& settings);

}  // namespace mimetra::bench
