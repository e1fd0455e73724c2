#pragma once

#include <string>
#include <vector>

#include "toolkit/drawing/chart.h"
#include "toolkit/mesh/context.h"
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

/// A report is smaller than this: bytes.
constexpr std::size_t kLargestReport = 10'000'000;

/// The strongest components that it shows.
constexpr std::size_t kMostInGallery = 60;

struct ReportPage {
  std::string html;
  int viewer_frames = 0;  ///< 0 without a 3D viewer
};

/// Draws and writes the page of a study, smaller than `largest` bytes (of which names and tables
/// need some ten thousand): frames are thinned and pictures shrunk. It asks for nothing from
/// elsewhere. `viewer`: the script of its 3D viewer, empty for none.
ReportPage report_page(const ReportStudy& study, const ReportView& view, std::string_view viewer,
                       std::size_t largest = kLargestReport, const Context& context = {});

}  // namespace mimetra
