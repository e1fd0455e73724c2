#pragma once

#include "toolkit/drawing/sheet_layout.h"

class vtkRenderer;

namespace mimetra {

/// Adds what is written on a sheet to a renderer over the whole picture: titles of rows and
/// columns, labels, colour bars, legends and the scale bar.
void annotate(vtkRenderer& renderer, const Sheet& sheet, const SheetLayout& layout);

}  // namespace mimetra
