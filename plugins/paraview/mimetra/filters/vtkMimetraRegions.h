#pragma once

#include <vtkNew.h>
#include <vtkPolyData.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// Regions of interest as fields on the input. This needs a class of its own because regions are
/// neither a sequence nor fields. Picking another region keeps the components.
class MIMETRAFILTERS_EXPORT vtkMimetraRegions : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraRegions, vtkMimetraFilter);
  static vtkMimetraRegions* New();

  /// Region whose vertices are 1 in the point data `displayed_region`; -1 for none.
  vtkSetMacro(DisplayedRegion, int);
  vtkGetMacro(DisplayedRegion, int);

 protected:
  vtkMimetraRegions();
  std::vector<std::string> wanted_outputs(const mimetra::Invocation& invocation) override;
  void prepare(const mimetra::Outcome& outcome, vtkPolyData& input) override;
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;

 private:
  vtkNew<vtkPolyData> fields_;
  int DisplayedRegion = -1;
};
