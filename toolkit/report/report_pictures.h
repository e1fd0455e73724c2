#pragma once

#include <vector>

#include "toolkit/drawing/chart.h"
#include "toolkit/pictures/film_strip.h"
#include "toolkit/report/report_study.h"

namespace mimetra {

/// From where meshes are seen, and their unit of length.
struct ReportView {
  Viewpoint viewpoint = {};
  std::string unit = {};

  static constexpr Option kUnit{"unit", &ReportView::unit};
};

/// Source, its regions, and what became of it, over time.
Sheet report_strip(const ReportStudy& study, const ReportView& view, int columns);

/// Components by their motion energy, at most `most` of those that move.
std::vector<int> strongest_components(const Components& components, std::size_t most);

/// Components at weight 1, coloured by displacement from none to their own largest. Titles tell
/// this and the component's number, from 0 as in files.
Sheet component_gallery(const Components& components, const std::vector<int>& shown,
                        const ReportView& view, int columns);

/// Weights of the strongest components over time, and of the target's strongest expressions.
std::vector<Chart> weight_charts(const ReportStudy& study);

/// Table I: error and time against the share of triangles. \pre the study has a transfer
std::vector<Chart> table_charts(const ReportedTransfer& transfer, const std::string& unit);

}  // namespace mimetra
