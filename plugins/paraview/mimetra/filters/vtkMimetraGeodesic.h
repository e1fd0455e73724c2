#pragma once

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// Distances along the mesh of the time step that is shown. A class of its own because of that:
/// they are computed anew at each time, from this time step alone.
class MIMETRAFILTERS_EXPORT vtkMimetraGeodesic : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraGeodesic, vtkMimetraFilter);
  static vtkMimetraGeodesic* New();

 protected:
  vtkMimetraGeodesic();
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;
};
