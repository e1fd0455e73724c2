#include "plugins/paraview/mimetra/filters/vtkMimetraComponents.h"

#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include "plugins/paraview/mimetra/filters/host_output.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

vtkStandardNewMacro(vtkMimetraComponents);

vtkMimetraComponents::vtkMimetraComponents() : vtkMimetraFilter("decompose") {
  SetNumberOfOutputPorts(2);
}

int vtkMimetraComponents::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkMultiBlockDataSet" : "vtkTable");
  return 1;
}

bool vtkMimetraComponents::moves(int) const {
  return false;
}

std::vector<std::string> vtkMimetraComponents::wanted_outputs(const Invocation&) {
  return {"weights-out"};
}

void vtkMimetraComponents::show(const Outcome& outcome, vtkPolyData& input, double,
                                vtkInformationVector* outputs) {
  const auto& components = std::get<Components>(outcome.outputs.at("out").front().data);
  const auto& weights = std::get<Table>(outcome.outputs.at("weights-out").front().data);
  vtkMultiBlockDataSet* blocks = vtkMultiBlockDataSet::GetData(outputs, 0);
  const Connectivity faces = connectivity_of(input, "the mesh");
  for (int k = 0; k < components.count(); ++k) {
    vtkNew<vtkPolyData> block;
    const PositionsView moved(components.displacements.row(k).data(), components.vertices(), 3);
    show_shape(*block, input, components.rest + moved);
    set_rest(*block, components.rest);
    add_displacement(*block, moved);
    const Field support{"support", Field::Location::vertices,
                        components.support.row(k).transpose()};
    add_field(*block, support, faces);
    blocks->SetBlock(static_cast<unsigned>(k), block);
    // As in the table of weights, whose first column is the time.
    blocks->GetMetaData(static_cast<unsigned>(k))
        ->Set(vtkCompositeDataSet::NAME(),
              weights.columns[static_cast<std::size_t>(k) + 1].c_str());
  }
  fill(*vtkTable::GetData(outputs, 1), weights);
}
