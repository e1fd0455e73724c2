#pragma once

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// Distances along the mesh of the time step that is shown.
class MIMETRAFILTERS_EXPORT vtkMimetraGeodesic : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraGeodesic, vtkMimetraFilter);
  static vtkMimetraGeodesic* New();

 protected:
  vtkMimetraGeodesic();
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;
};
