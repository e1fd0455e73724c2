#pragma once

#include <string>

#include "toolkit/mesh/context.h"
#include "toolkit/report/report_pictures.h"

namespace mimetra {

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
