#pragma once

#include "toolkit/drawing/chart.h"
#include "toolkit/io/data.h"

namespace mimetra {

/// Chart of a table. Table::picture selects two columns, with a line for each word of the word
/// column. By default all columns are drawn against the first. Empty cells and lines without points
/// are left out. With Table::picture, the y scale is logarithmic if y is positive and spans more
/// than a power of ten. Throws MismatchError for a table without numbers to show.
Chart chart_of(const Table& table);

}  // namespace mimetra
