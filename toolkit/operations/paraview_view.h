#pragma once

#include <filesystem>
#include <string>

#include "toolkit/operations/data.h"
#include "toolkit/operations/up_axis.h"

namespace mimetra {

/// A script that shows the regions of a written series (.pvd or .vtp) in ParaView (`paraview
/// --script=VIEW.py`): neighbours in different colours with a legend, the time, and the face from
/// the front. Under pvpython it draws the picture that is named behind it.
std::string paraview_view(const RegionData& regions, const std::filesystem::path& series,
                          UpAxis up = UpAxis::y);

}  // namespace mimetra
