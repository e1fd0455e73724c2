#pragma once

#include <vtkNew.h>
#include <vtkPolyData.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// The deformation of what comes in at port 0 on a target: a mesh at port 1, or a model's file. A
/// class of its own because the target is what moves, with its own data and the regions on it.
class MIMETRAFILTERS_EXPORT vtkMimetraTransfer : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraTransfer, vtkMimetraFilter);
  static vtkMimetraTransfer* New();

 protected:
  vtkMimetraTransfer();
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  std::vector<std::string> wanted_outputs(const mimetra::Invocation& invocation) override;
  void prepare(const mimetra::Outcome& outcome, vtkPolyData& input) override;
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;

 private:
  /// The target, or for a model of a file the input, on whose faces it is.
  vtkPolyData& shown_mesh(vtkPolyData& input) const;

  vtkNew<vtkPolyData> fields_;
};
