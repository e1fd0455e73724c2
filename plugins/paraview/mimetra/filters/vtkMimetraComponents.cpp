#include "plugins/paraview/mimetra/filters/vtkMimetraComponents.h"

#include <cmath>

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

namespace {

/// Offset of a component's mesh. Meshes are 1.2 times their size apart. Columns run along x, and
/// rows along the longer of the other axes, which is up in a face.
Eigen::RowVector3d place_of(int component, int count, const Positions& rest) {
  constexpr double kApart = 1.2;
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  const Eigen::RowVector3d size = rest.colwise().maxCoeff() - rest.colwise().minCoeff();
  const int up = size[1] >= size[2] ? 1 : 2;
  Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
  place[0] = kApart * size[0] * (component % columns);
  place[up] = -kApart * size[up] * (component / columns);
  return place;
}

}  // namespace

vtkMimetraComponents::vtkMimetraComponents() : vtkMimetraFilter("decompose") {
  SetNumberOfOutputPorts(2);
}

void vtkMimetraComponents::SetSideBySide(int on) {
  if (side_by_side_ == (on != 0)) return;
  side_by_side_ = on != 0;
  Modified();
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
    Positions rest = components.rest;
    if (side_by_side_) rest.rowwise() += place_of(k, components.count(), components.rest);
    show_shape(*block, input, rest + moved);
    set_rest(*block, rest);
    add_displacement(*block, moved);
    const Field support{"support", Field::Location::vertices,
                        components.support.row(k).transpose()};
    add_field(*block, support, faces);
    blocks->SetBlock(static_cast<unsigned>(k), block);
    // Blocks have the names of the weights; the first column of that table is the time.
    blocks->GetMetaData(static_cast<unsigned>(k))
        ->Set(vtkCompositeDataSet::NAME(),
              weights.columns[static_cast<std::size_t>(k) + 1].c_str());
  }
  fill(*vtkTable::GetData(outputs, 1), weights);
}
