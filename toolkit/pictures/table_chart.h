#pragma once

#include "toolkit/drawing/chart.h"
#include "toolkit/operations/data.h"

namespace mimetra {

/// The chart of a table: what Table::picture says, a line for each word of the word column, or all
/// columns against the first. Cells that are empty are left out, as are lines without a point. The
/// scale of y is logarithmic where a table says what it shows, and that spans more than a power of
/// ten above 0. Throws MismatchError for a table that has nothing to show.
Chart chart_of(const Table& table);

}  // namespace mimetra
