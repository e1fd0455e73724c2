#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/io/weight_track.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// Returns weights as a table: a column `time` if the times are known, and one column per name.
Table weight_table(const WeightTrack& track);

/// Returns the weights in a table, with or without a column `time`. Throws MismatchError for an
/// empty cell, with its row and column, for times that do not ascend, and for a table without
/// weights.
WeightTrack track_of(const Table& table);

/// True for a path in a format that stores a sequence's weights.
bool is_weight_file(const std::filesystem::path& path);

/// Throws UsageError if an output is requested in Live Link Face's format, and no expression has a
/// name of ARKit.
void check_live_link(const Invocation& invocation, const std::string& output,
                     const std::vector<std::string>& expressions);

/// Throws UsageError if the output is requested in Live Link Face's format, which has no weights of
/// each region.
void check_no_live_link(const Invocation& invocation, const std::string& output);

/// Adds the formats of tables. Weights are read and written, other tables are only written. Also
/// adds the formats of a sequence's weights.
void add_weight_formats(OperationTable& table);

}  // namespace mimetra
