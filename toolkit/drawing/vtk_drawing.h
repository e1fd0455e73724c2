#pragma once

#include "toolkit/drawing/chart.h"
#include "toolkit/drawing/picture.h"

namespace mimetra {

/// What draw() and png_of() are made of: VTK's renderers.
Image drawn(const Sheet& sheet, const Context& context);
Image drawn(const std::vector<Chart>& row, const ChartSize& size);
std::string encoded_png(const Image& image);

}  // namespace mimetra
