#pragma once

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// The deformation of what comes in at port 0 on a target: a mesh at port 1, or a model's file. A
/// class of its own because of that port, whose mesh is what moves, and because it shows the
/// regions too.
class MIMETRAFILTERS_EXPORT vtkMimetraTransfer : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraTransfer, vtkMimetraFilter);
  static vtkMimetraTransfer* New();

 protected:
  vtkMimetraTransfer();
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                          vtkInformationVector* outputs) override;
  std::vector<std::string> wanted_outputs(const mimetra::Invocation& invocation) override;
  void give_further_inputs(vtkInformationVector** inputs) override;
  void prepare(const mimetra::Outcome& outcome, vtkPolyData& input) override;
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;

 private:
  vtkSmartPointer<vtkPolyData> target_;
  vtkNew<vtkPolyData> fields_;
  std::optional<Origin> given_;
};
