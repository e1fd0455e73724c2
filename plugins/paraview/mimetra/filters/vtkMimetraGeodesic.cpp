#include "plugins/paraview/mimetra/filters/vtkMimetraGeodesic.h"

#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

#include "toolkit/operations/operation.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

vtkStandardNewMacro(vtkMimetraGeodesic);

vtkMimetraGeodesic::vtkMimetraGeodesic() : vtkMimetraFilter("geodesic", Takes::shown_time_step) {}

void vtkMimetraGeodesic::show(const Outcome& outcome, vtkPolyData& input, double,
                              vtkInformationVector* outputs) {
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  output->ShallowCopy(&input);
  const auto& made = std::get<FieldSequence>(outcome.outputs.at("out").front().data);
  for (const Field& field : made.fields) add_field(*output, field, made.frames->connectivity());
}
