#include "plugins/paraview/mimetra/filters/vtkMimetraRegions.h"

#include <algorithm>

#include <vtkObjectFactory.h>

#include "plugins/paraview/mimetra/filters/host_output.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/operations/colors.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

vtkStandardNewMacro(vtkMimetraRegions);

namespace {

/// Field that is 1 on the vertices of one region. Throws UsageError if there is no such region.
Field mask_of(const Regions& regions, int index) {
  const int count = static_cast<int>(regions.regions.size());
  if (index >= count) {
    throw UsageError("Displayed Region: expected at most " + std::to_string(count - 1) +
                     ", the last region, found " + std::to_string(index));
  }
  Field mask{"displayed_region", Field::Location::vertices, Eigen::VectorXd::Zero(regions.vertices),
             true};
  for (const VertexIndex vertex : regions.regions[static_cast<std::size_t>(index)].vertices) {
    mask.values(vertex, 0) = 1;
  }
  return mask;
}

}  // namespace

vtkMimetraRegions::vtkMimetraRegions() : vtkMimetraFilter("regions") {}

std::vector<std::string> vtkMimetraRegions::wanted_outputs(const Invocation&) {
  return {"components-out"};
}

void vtkMimetraRegions::prepare(const Outcome& outcome, vtkPolyData& input) {
  const auto& made = std::get<RegionData>(outcome.outputs.at("out").front().data);
  const Regions& regions = made.regions;
  const FieldSequence& shown = made.fields;
  std::vector<Field> fields = shown.fields;
  const auto region = std::ranges::find(fields, "region", &Field::name);
  fields.push_back(region_color_field(*region, shown.frames->connectivity()));
  if (DisplayedRegion >= 0) fields.push_back(mask_of(regions, DisplayedRegion));
  make_fields(*fields_, input, fields, shown.sequence().connectivity());
}

void vtkMimetraRegions::show(const Outcome& outcome, vtkPolyData& input, double time,
                             vtkInformationVector* outputs) {
  const auto& shown = std::get<RegionData>(outcome.outputs.at("out").front().data).fields;
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  output->ShallowCopy(&input);
  share_fields(*fields_, *output);
  const int frame = frame_at(shown.sequence(), time);
  add_displacement(*output, shown.sequence().frame(frame) - shown.sequence().rest());
}
