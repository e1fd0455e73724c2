#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/io/weight_track.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// Weights as a table: a column `time`, where there are times, and one for each name.
Table weight_table(const WeightTrack& track);

/// The weights that a table holds, a column `time` or none. Throws MismatchError that names the row
/// and the column of a cell that is empty, for times that do not ascend, and where there is no
/// weight.
WeightTrack track_of(const Table& table);

/// True for a path of a form that sequences are weights in.
bool is_weight_file(const std::filesystem::path& path);

/// Throws UsageError where an output is wanted in Live Link Face's form and none of its expressions
/// is ARKit's.
void check_live_link(const Invocation& invocation, const std::string& output,
                     const std::vector<std::string>& expressions);

/// Throws UsageError where weights of each region are wanted there in Live Link Face's form.
void check_no_live_link(const Invocation& invocation, const std::string& output);

/// Adds the formats of tables: weights are read and written, others written; and those of a
/// sequence's weights.
void add_weight_formats(OperationTable& table);

}  // namespace mimetra
