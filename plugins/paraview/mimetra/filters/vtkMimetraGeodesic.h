#pragma once

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// Distances along the mesh of the shown time step. This needs a class of its own because the
/// distances are computed anew at each time, from that time step alone.
class MIMETRAFILTERS_EXPORT vtkMimetraGeodesic : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraGeodesic, vtkMimetraFilter);
  static vtkMimetraGeodesic* New();

 protected:
  vtkMimetraGeodesic();
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;
};
