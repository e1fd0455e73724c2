#pragma once

#include <vtkNew.h>
#include <vtkPolyData.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// Deformation of the mesh at port 0, applied to a target: a mesh at port 1, or a model's file.
/// This needs a class of its own because the output is the target, with its own data and the
/// regions on it.
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
  /// The target, or the input if the target is a file, whose model has the input's faces.
  vtkPolyData& shown_mesh(vtkPolyData& input) const;

  vtkNew<vtkPolyData> fields_;
};
