#pragma once

#include <vector>

#include <mimetra/vtk/chart.h>
#include <mimetra/vtk/film_strip.h>
#include <mimetra/vtk/report_study.h>

namespace mimetra {

/// From where meshes are seen, and their unit of length.
struct ReportView {
  double yaw = 15;   ///< degrees
  double pitch = 5;  ///< degrees
  bool z_up = false;
  std::string unit;
};

/// Source, its regions, and what became of it, over time.
Sheet report_strip(const ReportStudy& study, const ReportView& view, int columns);

/// Each component at weight 1, coloured by displacement from none to its own largest, which its
/// title tells; in the order of the regions. \pre the study has components
Sheet component_gallery(const ReportStudy& study, const ReportView& view, int columns);

/// Weights of the strongest components over time, and of the target's strongest expressions.
std::vector<Chart> weight_charts(const ReportStudy& study);

/// Table I: error and time against the share of triangles. \pre the study has a transfer
std::vector<Chart> table_charts(const ReportedTransfer& transfer, const std::string& unit);

}  // namespace mimetra
