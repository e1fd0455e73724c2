#pragma once

#include <string>

#include <vtkNew.h>
#include <vtkPolyData.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// An operation of a plugin: the sequence or the fields that it makes of its input's. What it makes
/// on the input's own faces is shown with the input's data, anything else as a mesh of its own.
class MIMETRAFILTERS_EXPORT vtkMimetraOperation : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraOperation, vtkMimetraFilter);
  static vtkMimetraOperation* New();

  /// Which one it is, set before anything else.
  void SetOperation(const char* name);

 protected:
  vtkMimetraOperation();
  std::vector<std::string> wanted_outputs(const mimetra::Invocation& invocation) override;
  void prepare(const mimetra::Outcome& outcome, vtkPolyData& input) override;
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;

 private:
  enum class Shown { on_the_input, in_another_shape, as_a_mesh_of_its_own };

  Shown shown_ = Shown::on_the_input;
  vtkNew<vtkPolyData> shared_;  ///< what all time steps share: fields, and faces of its own
};
