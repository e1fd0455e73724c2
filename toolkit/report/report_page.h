#pragma once

#include <string>
#include <vector>

#include "toolkit/drawing/chart.h"
#include "toolkit/mesh/context.h"
#include "toolkit/pictures/film_strip.h"
#include "toolkit/report/report_study.h"

namespace mimetra {

/// View of the meshes, and their unit of length.
struct ReportView {
  Viewpoint viewpoint = {};
  std::string unit = {};

  static constexpr Option kUnit{"unit", &ReportView::unit};
};

/// Film strip of the source, its regions and the result.
Sheet report_strip(const ReportStudy& study, const ReportView& view, int columns);

/// At most `most` components that move, ordered by motion energy.
std::vector<int> strongest_components(const Components& components, std::size_t most);

/// Components at weight 1, coloured by displacement, up to each one's largest. Titles give this
/// largest displacement and the component's number, 0-based as in files.
Sheet component_gallery(const Components& components, const std::vector<int>& shown,
                        const ReportView& view, int columns);

/// Weights over time: of the strongest components, and of the target's strongest expressions.
std::vector<Chart> weight_charts(const ReportStudy& study);

/// Table I: error and time against the share of triangles. \pre the study has a transfer
std::vector<Chart> table_charts(const ReportedTransfer& transfer, const std::string& unit);

/// Maximum size of a report in bytes.
constexpr std::size_t kLargestReport = 10'000'000;

/// Maximum number of components in the gallery.
constexpr std::size_t kMostInGallery = 60;

struct ReportPage {
  std::string html;
  int viewer_frames = 0;  ///< 0 without a 3D viewer
};

/// Draws and writes the page of a study. The page loads nothing from elsewhere. Frames are thinned
/// and pictures shrunk to stay below `largest` bytes. Names and tables alone need about ten
/// thousand. `viewer`: script of the 3D viewer, empty for none.
ReportPage report_page(const ReportStudy& study, const ReportView& view, std::string_view viewer,
                       std::size_t largest = kLargestReport, const Context& context = {});

}  // namespace mimetra
